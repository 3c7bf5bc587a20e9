// How a rank's frame begins: what it takes over from the frame before, its seeds, and the others'.
#include <algorithm>
#include <bit>
#include <utility>

#include "parallel/worker.h"

namespace pprt {
namespace {

// Wall clock: the share of a frame's period that a rank waits for its neighbours' seeds before it goes on
// without.
constexpr double kSeedPatience = 0.1;

// Of a frame's time, what putting cast samples back may take.
constexpr double kCastShare = 0.5;

// How far an eye at rest may move, in a scene of size 1: what interpolating equal positions leaves.
constexpr double kAtRest = 1e-9;

// Of the samples that may be carried some are cast before the others, to know how they fare, and one in eight
// of those is tried: one in 64 of all, fewer of so many that a few hundred tell as much.
constexpr std::uint64_t kDrawnForEachTried = 8;
std::uint64_t tried_one_of(std::uint64_t samples) {
  constexpr std::uint64_t kAtLeast = 64, kEnough = 512;
  return std::max(kAtLeast, std::bit_ceil(samples / kEnough));
}

// Of seeds that others tell: which one it is does not matter here.
constexpr std::uint32_t kSomeSeed = 0;

CastSettings verified(int life) {
  return {CastMethod::kVerified, life, life};
}

}  // namespace

void Worker::prepare(const FrameOrder& order) {
  probe_.look_from(order.camera);
  sought_.clear();
  anchors_at_most_ = 0;
  const bool new_partition = !order.owners.empty();
  const Carry carry = carried_into(order);
  const Missed missed = std::exchange(missed_, {});
  balancer_.begin_frame(carry != Carry::kAccumulate || missed.triangulation, known_before(order, missed));
  const bool eye_rests = camera_before_ && (order.camera.eye - camera_before_->eye).length() <= kAtRest;
  if (!camera_before_ || *camera_before_ != order.camera) projected_shapes_.forget();
  camera_before_ = order.camera;
  if (carry == Carry::kAccumulate && missed.triangulation) {
    catch_up(order, missed);
    return;
  }
  if (carry == Carry::kAccumulate) {
    if (new_partition) {
      adopt_partition(order, true);
      send_handed_over(order);
    }
    report_.samples_cast = in_region_;
    return;
  }
  // From the frame before: with its samples, and with what refinement has learned.
  const bool goes_on = carry != Carry::kNothing && !missed.cut;
  std::vector<Sample> survivors;
  if (goes_on) survivors = cast(order, eye_rests);
  const bool has_anchors = goes_on && carry == Carry::kCastWherePaying;
  if (has_anchors) {
    anchors_.note(mesh_.samples());
  } else {
    anchors_.clear();
  }
  report_.cpu_ms.casting += clock_->lap_ms();
  if (new_partition) adopt_partition(order, false);
  if (has_anchors) anchors_at_most_ = kAnchorShare * static_cast<double>(in_region_);
  begin_triangulation(order.index, goes_on);
  trace_seeds(order);
  settle(order, survivors);
}

Balancer::Known Worker::known_before(const FrameOrder& order, const Missed& missed) const {
  if (order.cut || missed.cut || !camera_before_) return Balancer::Known::kNothing;
  return order.camera == *camera_before_ ? Balancer::Known::kAll : Balancer::Known::kSome;
}

void Worker::begin_triangulation(int epoch, bool goes_on) {
  under_way_.clear();  // of the triangulation before
  if (goes_on) {
    mesh_.restart();
  } else {
    mesh_.clear();
    next_id_ = 0;  // which samples casting draws shall not depend on frames before either
  }
  exchange_.clear();
  epoch_ = epoch;
  in_region_ = 0;
}

// The master has cut the image anew. The samples of tiles that go to another rank are told to it if they are
// kept.
void Worker::adopt_partition(const FrameOrder& order, bool keep_samples) {
  Partition next = exchange_.partition();
  if (order.owners.size() != next.owner.size()) throw ProtocolError("a cut that is none of this image");
  next.owner = order.owners;
  std::fill(next.version.begin(), next.version.end(), first_version(order.generation));
  for (int rank = 0; keep_samples && rank < network_.size(); ++rank) {
    std::vector<int> moved;
    for (const int tile : mesh_.region().tiles()) {
      if (rank != network_.rank() && next.owner[static_cast<std::size_t>(tile)] == rank)
        moved.push_back(tile);
    }
    if (!moved.empty()) exchange_.introduce(mesh_, moved, rank);
  }
  std::size_t own = 0;
  for (std::size_t tile = 0; tile < next.owner.size() && own < order.tiles.size(); ++tile) {
    if (next.owner[tile] != network_.rank()) continue;
    const TileEstimate& found = order.tiles[own++];
    if (!mesh_.region().owns_tile(static_cast<int>(tile))) balancer_.expect(static_cast<int>(tile), found);
  }
  report_.bytes_balance +=
      owner_runs(order.owners).size() * sizeof(OwnerRun) + order.tiles.size() * sizeof(TileEstimate);
  exchange_.repartition(mesh_, next);
  own_region_changed();
}

// What the ranks tell each other before the first sample of a frame that keeps its triangulation but not its
// partition.
void Worker::send_handed_over(const FrameOrder& order) {
  send_bundles(order, kSeedRound, false);
  receive_bundles(order, kSeedRound);
}

std::vector<Sample> Worker::cast(const FrameOrder& order, bool eye_rests) {
  if (order.carry == Carry::kCastWherePaying)
    return eye_rests ? cast_at_rest(order) : cast_where_paying(order);
  const bool by_paper = order.carry == Carry::kCastPaper;
  std::vector<Sample> survivors =
      cast_into(order, by_paper ? CastSettings() : verified(kVerifiedMaxAge)).samples;
  keep_affordable(order, kCastShare, survivors);
  if (!by_paper && !eye_rests) drop_hidden_of(survivors);
  return survivors;
}

CastResult Worker::cast_into(const FrameOrder& order, const CastSettings& settings) {
  clock_->spend(Work::kCastSample, in_region_ / settings.one_of);
  return cast_samples(mesh_, order.camera, order.number, settings);
}

// Putting them back may take a share of a frame at most; the rest is for new samples.
void Worker::keep_affordable(const FrameOrder& order, double share, std::vector<Sample>& survivors) const {
  if (order.deadline_s > 0) keep_youngest(survivors, clock_->affordable(Work::kKeptSample, share));
}

void Worker::drop_hidden_of(std::vector<Sample>& survivors) {
  drop_hidden(survivors, [&](const Vec3f& hit, bool at_infinity) { return see(hit, at_infinity); });
}

CastSummary Worker::known_of(const CastResult& cast) const {
  const auto of_eye = std::count_if(cast.samples.begin(), cast.samples.end(),
                                    [](const Sample& s) { return s.ray.eye_dependent; });
  const double count = static_cast<double>(std::max<std::size_t>(cast.samples.size(), 1));
  return {cast.moved, static_cast<double>(of_eye) / count,
          static_cast<double>(in_region_) / static_cast<double>(mesh_.region().pixel_count())};
}

std::vector<Sample> Worker::cast_at_rest(const FrameOrder& order) {
  CastResult cast = cast_into(order, verified(kLongLife));
  const CastLimits limits = cast_limits_at_rest(known_of(cast));
  if (limits.one_a_pixel) keep_youngest_of_pixels(cast.samples);
  keep_affordable(order, limits.share, cast.samples);
  return std::move(cast.samples);
}

// Whether casting pays is found out from a few samples before the others are touched: where it does not, it
// costs next to nothing.
std::vector<Sample> Worker::cast_where_paying(const FrameOrder& order) {
  const std::uint64_t tried_of = tried_one_of(in_region_);
  CastSettings settings = verified(kLongLife);
  settings.one_of = tried_of / kDrawnForEachTried;
  CastResult drawn = cast_into(order, settings);
  const CastSummary known = known_of(drawn);
  CastEvidence evidence = order.evidence;
  evidence += own_evidence_;
  const int life = cast_life(evidence, known.eye_dependent);
  std::erase_if(drawn.samples,
                [&](const Sample& s) { return order.number - s.frame > life || !is_one_of(s, tried_of); });
  std::vector<Sample> tried = try_some(order, drawn.samples);
  evidence += report_.evidence;
  const CastLimits limits = cast_limits(evidence, known, cast_prices());
  if (limits.share == 0) return tried;

  settings = verified(life);
  if (!limits.eye_dependent) settings.max_age_eye_dependent = 0;
  std::vector<Sample> survivors = cast_into(order, settings).samples;
  std::erase_if(survivors, [&](const Sample& s) { return is_one_of(s, tried_of); });
  keep_affordable(order, limits.share, survivors);
  drop_hidden_of(survivors);
  survivors.insert(survivors.end(), tried.begin(), tried.end());
  return survivors;
}

// Asks for each whether it is seen; where its colour depends on the eye, it is traced anew and becomes a
// sample of this frame. Returns those that are right.
std::vector<Sample> Worker::try_some(const FrameOrder& order, const std::vector<Sample>& survivors) {
  report_.cpu_ms.casting += clock_->lap_ms();
  std::vector<Sample> tried;
  for (const Sample& s : survivors) {
    if (see(s.ray.hit, s.ray.at_infinity)) tried.push_back(s);
  }
  CastEvidence& evidence = report_.evidence;
  evidence.asked += static_cast<double>(survivors.size());
  evidence.hidden += static_cast<double>(survivors.size() - tried.size());
  const double lap = clock_->lap_ms();
  evidence.asked_ms += lap;
  report_.cpu_ms.casting += lap;
  for (Sample& s : tried) {
    if (!s.ray.eye_dependent) continue;
    const Color stale = s.ray.color;
    s = trace(order, s.x, s.y);
    ++report_.samples_new;
    ++evidence.stale;
    evidence.stale_error += display_error(stale, s.ray.color);
  }
  return tried;
}

bool Worker::see(const Vec3f& hit, bool at_infinity) {
  look_for_messages();
  clock_->spend(Work::kRay, 1);
  return probe_.visible(hit, at_infinity);
}

// On rank 0 the frame before may become whole, or due, while this one is prepared.
void Worker::look_for_messages() {
  constexpr unsigned kSamplesPerLook = 128;
  if (++prepared_ % kSamplesPerLook == 0) inbox_.pump();
}

void Worker::trace_seeds(const FrameOrder& order) {
  const std::vector<Vec2d>& seeds = exchange_.seeds().points;
  constexpr std::uint32_t kCorners = 4;  // every mesh needs them, so that its hull is the image
  for (std::uint32_t i = 0; i < seeds.size(); ++i) {
    const bool own = mesh_.region().owns_point(seeds[i].x, seeds[i].y);
    if (i >= kCorners && !own) continue;
    // A foreign corner is its owner's sample, which tells it to others and counts it.
    const int owner = exchange_.owner_of(seeds[i].x, seeds[i].y);
    insert(trace(order, seeds[i].x, seeds[i].y), {owner, i});
    report_.samples_new += own;
  }
}

// Seeds cross the borders first; then each survivor goes to the rank whose tile it landed in.
void Worker::settle(const FrameOrder& order, const std::vector<Sample>& survivors) {
  std::vector<Sample> own;
  std::vector<std::vector<Sample>> emigrants(static_cast<std::size_t>(network_.size()));
  for (const Sample& s : survivors) {
    const int owner = exchange_.owner_of(s.x, s.y);
    (owner == network_.rank() ? own : emigrants[static_cast<std::size_t>(owner)]).push_back(s);
  }
  for (int rank = 0; rank < network_.size(); ++rank) {
    if (rank == network_.rank()) continue;
    std::vector<Sample> samples = exchange_.take_outbox(rank);
    const auto& guests = emigrants[static_cast<std::size_t>(rank)];
    samples.insert(samples.end(), guests.begin(), guests.end());
    const bool peer = std::binary_search(exchange_.seed_peers().begin(), exchange_.seed_peers().end(), rank);
    const bool concerned = !samples.empty() || peer;
    if (!concerned && !clock_->in_lockstep()) continue;
    send_bundle(rank, {order.index, epoch_, kSeedRound, false, 0, {}, {}, {}, std::move(samples)}, concerned);
  }
  receive_seeds(order, own);
  report_.cpu_ms.sampling += clock_->lap_ms();
  keep_affordable(order, kCastShare, own);
  mesh_.insert_all(own, [&](const Sample& s, bool is_new) { note_put_back(s, is_new); });
  const double lap = clock_->lap_ms();
  report_.cpu_ms.casting += lap;
  report_.evidence.reinserted += static_cast<double>(own.size());
  report_.evidence.reinserted_ms += lap;
}

void Worker::receive_seeds(const FrameOrder& order, std::vector<Sample>& survivors) {
  const std::vector<int>& peers = exchange_.seed_peers();
  const auto of_this_round = [&](const Inbox::Arrived& a) {
    return a.bundle.frame_index == order.index && a.bundle.round == kSeedRound;
  };
  const auto awaited = [&](const Inbox::Arrived& a) {
    return of_this_round(a) &&
           (clock_->in_lockstep() || std::binary_search(peers.begin(), peers.end(), a.from));
  };
  const std::size_t expected =
      clock_->in_lockstep() ? static_cast<std::size_t>(network_.size() - 1) : peers.size();
  const bool has_patience = clock_->in_lockstep() || order.deadline_s == 0;
  await([&] {
    return inbox_.count_bundles(awaited) >= expected ||
           (!has_patience && clock_->frame_seconds() * settings_.frames_per_second > kSeedPatience);
  });
  // What was said before is heard before: a handshake counts on the transfers that were sent ahead of it.
  take_in(inbox_.take_bundles([&](const Inbox::Arrived& a) { return a.bundle.frame_index < order.index; }));
  const std::vector<Inbox::Arrived> bundles = inbox_.take_bundles(of_this_round);
  for (const Inbox::Arrived& arrived : bundles) handshake_.hear(arrived.from, arrived.bundle.handshake);
  for (const Inbox::Arrived& arrived : bundles) take_in_seeds(arrived);
  for (const Inbox::Arrived& arrived : bundles) take_over_survivors(arrived, survivors);
}

// It counts like one traced here: a tile's quality is that of all its samples, and so is what it has taken.
bool Worker::put_back(const Sample& survivor) {
  return note_put_back(survivor, mesh_.insert(survivor));
}

bool Worker::note_put_back(const Sample& survivor, bool is_new) {
  look_for_messages();
  if (!note_insertion(survivor, {network_.rank(), {}, true}, is_new)) return false;
  account_for(survivor);
  report_.samples_cast += survivor.frame != frame_number_;
  return true;
}

// What comes before a fresh triangulation's first round and lies elsewhere is another rank's seed.
void Worker::take_in_seeds(const Inbox::Arrived& arrived) {
  for (const Sample& s : arrived.bundle.samples) {
    if (mesh_.region().owns_point(s.x, s.y)) continue;
    ++(insert(s, {arrived.from, kSomeSeed}) ? report_.samples_received : report_.samples_known);
  }
}

// And what lies in the own region is a survivor that landed here. Who hands it over keeps none: it is this
// rank's to tell, to the former owner too.
void Worker::take_over_survivors(const Inbox::Arrived& arrived, std::vector<Sample>& survivors) const {
  std::copy_if(arrived.bundle.samples.begin(), arrived.bundle.samples.end(), std::back_inserter(survivors),
               [&](const Sample& s) { return mesh_.region().owns_point(s.x, s.y); });
}

// Seeds and survivors that were not waited for. Tiles may have changed hands since they were sent, and
// whether the sender keeps a sample cannot be told: each goes by the update rule as if it were traced here,
// hence also to the owner of a tile that this rank has had.
void Worker::take_in_late_seeds(const Inbox::Arrived& arrived) {
  for (const Sample& s : arrived.bundle.samples) {
    const bool inserted = insert(s, {network_.rank(), {}});
    ++(inserted ? report_.samples_received : report_.samples_known);
    report_.samples_cast += inserted && mesh_.region().owns_point(s.x, s.y);
  }
}

}  // namespace pprt
