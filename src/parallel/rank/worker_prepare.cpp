// How a rank's frame begins: what it takes over from the frame before, its seeds, and the others'.
#include <algorithm>
#include <utility>

#include "parallel/rank/worker.h"

namespace pprt {

void Worker::rehearse(const FrameOrder& first, bool is_last) {
  if (!clock_->learns_from_rehearsal()) return;
  // With more time than a frame has: it is to be known what seeing and painting take that do not fit yet.
  constexpr double kMoreTime = 4;
  constexpr std::size_t kManyAsSeeds = 4;
  Sampler& sampler = sampler_.sampler();
  clock_->begin_frame(first);
  tracer_.begin_frame(first);
  sampler.camera_changed();
  sampler.clear(true);
  const auto insert = [&](const Vec2d& at) {
    return sampler.insert(tracer_.rehearse(at.x, at.y, std::min(1.0, sampler.footprint(at))));
  };
  const std::int64_t began_ns = clock_->used_ns();
  for (const SeedPoint& seed : sampler.seeds()) insert(seed.at);
  foretell(began_ns, false, kMoreTime, {});
  const std::size_t enough = kManyAsSeeds * sampler.size();
  for (std::optional<Vec2d> at; sampler.size() < enough && (at = sampler.next_point());)
    if (!insert(*at)) break;
  clock_->begin_packet(sampler.size());
  const std::int64_t painting_began_ns = clock_->used_ns();
  picture_.reconstruct(sampler, {});
  clock_->mixed_pixels_found(sampler.mixed_pixels());
  // The first time memory is cold.
  if (is_last) clock_->end_frame(1e-6 * static_cast<double>(clock_->used_ns() - painting_began_ns), 1);
  is_rehearsed_ = true;
}

void Worker::prepare(const FrameOrder& order) {
  // How far an eye at rest may move, in a scene of size 1: what interpolating equal positions leaves.
  constexpr double kAtRest = 1e-9;
  tracer_.begin_frame(order);
  if (tracer_.moves()) timer_.end_stage(&StageTimes::moving);
  const MissedFrames missed = ownership_.take_missed();
  const Carry carry = ownership_.carry_into(order);
  const bool rests = carry == Carry::kAccumulate;  // then it is painted in turns
  costs_.begin_frame(!rests || missed.picture, likeness_to_last(order, missed),
                     rests ? 0 : clock_->mixed_pixel_units());
  const bool eye_rests =
      last_camera_ && !tracer_.moves() && (order.camera.eye - last_camera_->eye).length() <= kAtRest;
  if (last_camera_ != order.camera || tracer_.moves()) sampler_.sampler().camera_changed();
  last_camera_ = order.camera;

  if (!rests) {
    begin_anew(order, carry != Carry::kNothing && !missed.cut, eye_rests);
  } else if (missed.picture) {
    rejoin(order, missed);
  } else {
    if (!order.owners.empty()) {
      ownership_.repartition(order, true);
      exchange_bundles(false);
    }
    sampler_.carry_on();
  }
}

FrameLikeness Worker::likeness_to_last(const FrameOrder& order, const MissedFrames& missed) const {
  if (order.cut || missed.cut || !last_camera_) return FrameLikeness::kUnknown;
  return order.camera == *last_camera_ && !tracer_.moves() ? FrameLikeness::kSame : FrameLikeness::kSimilar;
}

// The others accumulate in a triangulation that they have begun without this rank: makes its part of it, from
// the seeds of that frame and from what they have sent since.
void Worker::rejoin(const FrameOrder& order, const MissedFrames& missed) {
  if (!order.owners.empty()) ownership_.repartition(order, false);
  if (tracer_.moves()) anchors_.forget();
  begin_picture(missed.begun_in, !missed.cut);
  sampler_.trace_seeds();
  take_in(bundles_.receive());
}

// Begins a triangulation, with samples cast from the frame before or with seeds alone.
void Worker::begin_anew(const FrameOrder& order, bool keeps_samples, bool eye_rests) {
  std::vector<Sample> cast;
  if (keeps_samples) cast = reprojection_.cast(order, eye_rests);
  const bool seeks_anchors = keeps_samples && order.carry == Carry::kCastWherePaying &&
                             sampler_.traits().cast_use == CastUse::kSamples;
  if (seeks_anchors) {
    anchors_.note(sampler_.sampler().samples());
    if (tracer_.moves()) anchors_.carry(tracer_.probe().carry);
  } else {
    anchors_.forget();
  }
  timer_.end_stage(&StageTimes::casting);
  if (!order.owners.empty()) ownership_.repartition(order, false);
  if (seeks_anchors) anchors_.allow(sampler_.in_region());
  begin_picture(order.index, keeps_samples || std::exchange(is_rehearsed_, false));
  trace_seeds(keeps_samples);
  distribute(order, cast);
}

void Worker::trace_seeds(bool has_last_picture) {
  const std::int64_t began_ns = clock_->used_ns();
  sampler_.trace_seeds();
  foretell(began_ns, has_last_picture, 1, [this] { bundles_.look(); });
}

// How many samples there will be is told by the last picture. Without one it is told by the time that the
// first ones take.
void Worker::foretell(std::int64_t began_ns, bool has_last_picture, double periods,
                      std::function<void()> pause) {
  const std::size_t seeds = sampler_.sampler().size();
  const double each_s = 1e-9 * static_cast<double>(clock_->used_ns() - began_ns) /
                        static_cast<double>(std::max<std::size_t>(seeds, 1));
  std::optional<TimeForecast> forecast = clock_->forecast(seeds, each_s);
  if (!forecast) return;
  if (!has_last_picture) sampler_.expect_growth(forecast->samples / static_cast<double>(seeds));
  forecast->samples *= periods;
  forecast->pause = std::move(pause);
  sampler_.sampler().expect_time(*forecast);
}

void Worker::begin_picture(int begun_in, bool keep_learned) {
  bundles_.begin_picture(begun_in);
  sampler_.begin_picture(keep_learned);
  if (!keep_learned) probe_price_ = {};
  picture_.forget();
}

// Sends seeds to the ranks that they concern and each cast sample to the rank whose tile it landed in; then
// inserts what landed here.
void Worker::distribute(const FrameOrder& order, const std::vector<Sample>& cast) {
  const SampleExchange& known = sampler_.exchange();
  std::vector<std::vector<Sample>> landed(static_cast<std::size_t>(network_.size()));
  for (const Sample& s : cast)
    landed[static_cast<std::size_t>(known.partition().owner_at(s.x, s.y))].push_back(s);
  const std::vector<int>& peers = known.seed_peers();
  for (int rank = 0; rank < network_.size(); ++rank) {
    if (rank == network_.rank()) continue;
    std::vector<Sample> samples = sampler_.take_outbox(rank);
    const std::vector<Sample>& there = landed[static_cast<std::size_t>(rank)];
    samples.insert(samples.end(), there.begin(), there.end());
    const bool concerns = !samples.empty() || std::binary_search(peers.begin(), peers.end(), rank);
    bundles_.send(rank, concerns, {.samples = std::move(samples)});
  }
  std::vector<Sample> own = std::move(landed[static_cast<std::size_t>(network_.rank())]);
  const std::vector<Sample> arrived = receive_seeds();
  own.insert(own.end(), arrived.begin(), arrived.end());
  timer_.end_stage(&StageTimes::sampling);

  reprojection_.keep_affordable(order, own);
  sampler_.reinsert_all(own);
  CastEvidence& evidence = reprojection_.evidence();
  evidence.reinserted += static_cast<double>(own.size());
  evidence.reinserted_ms += timer_.end_stage(&StageTimes::casting);
}

// Inserts the seeds of other ranks: what comes before a triangulation's first round and lies elsewhere.
// Returns what lies in the own region: cast samples that landed here. Their sender keeps none of them, so
// they are this rank's to announce, to the sender too.
std::vector<Sample> Worker::receive_seeds() {
  bundles_.await_seeds(sampler_.exchange().seed_peers());
  // What was sent before is taken in before: a handshake counts on the transfers that were sent ahead of it.
  take_in(bundles_.take_earlier());
  std::vector<Sample> landed;
  for (const auto& [from, bundle] : bundles_.take_of_round()) {
    std::vector<Sample> seeds;
    for (const Sample& s : bundle.samples) (sampler_.owns(s) ? landed : seeds).push_back(s);
    sampler_.insert_received(seeds, from);
  }
  return landed;
}

}  // namespace pprt
