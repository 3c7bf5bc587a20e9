// How a rank's frame begins: what it takes over from the frame before, its seeds, and the others'.
#include <algorithm>
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

// Of seeds that others tell: which one it is does not matter here.
constexpr std::uint32_t kSomeSeed = 0;

}  // namespace

void Worker::prepare(const FrameOrder& order) {
  probe_.look_from(order.camera);
  const bool new_partition = !order.owners.empty();
  const Carry carry = carried_into(order);
  const Missed missed = std::exchange(missed_, {});
  balancer_.begin_frame(carry != Carry::kAccumulate || missed.triangulation, known_before(order, missed));
  const bool eye_rests = camera_before_ && (order.camera.eye - camera_before_->eye).length() <= kAtRest;
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
  std::vector<Sample> survivors;
  if (carry != Carry::kNothing && !missed.cut) survivors = cast(order, eye_rests);
  report_.cpu_ms.casting += clock_->lap_ms();
  if (new_partition) adopt_partition(order, false);

  begin_triangulation(order.index);
  trace_seeds(order);
  settle(order, survivors);
}

Balancer::Known Worker::known_before(const FrameOrder& order, const Missed& missed) const {
  if (order.cut || missed.cut || !camera_before_) return Balancer::Known::kNothing;
  return order.camera == *camera_before_ ? Balancer::Known::kAll : Balancer::Known::kSome;
}

void Worker::begin_triangulation(int epoch) {
  under_way_.clear();  // of the triangulation before
  mesh_.clear();
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

// Putting them back may take a share of a frame at most; the rest is for new samples.
std::vector<Sample> Worker::cast(const FrameOrder& order, bool eye_rests) {
  clock_->spend(Work::kCastSample, in_region_);
  if (order.carry != Carry::kCastPaper) return cast_verified(order, eye_rests);
  std::vector<Sample> survivors = cast_samples(mesh_, order.camera, order.number, {}).survivors;
  if (order.deadline_s > 0) keep_youngest(survivors, clock_->affordable(Work::kKeptSample, kCastShare));
  return survivors;
}

std::vector<Sample> Worker::cast_verified(const FrameOrder& order, bool eye_rests) {
  const bool by_choice = order.carry == Carry::kCastWherePaying;
  const int life = by_choice ? kLongLife : kVerifiedMaxAge;
  CastResult cast = cast_samples(mesh_, order.camera, order.number, {CastMethod::kVerified, life, life});
  std::vector<Sample>& survivors = cast.survivors;
  const double share = by_choice ? choose(order, cast, eye_rests) : kCastShare;
  if (order.deadline_s > 0) keep_youngest(survivors, clock_->affordable(Work::kKeptSample, share));
  if (!eye_rests) {
    drop_hidden(survivors, [&](const Vec3f& hit, bool at_infinity) { return see(hit, at_infinity); });
  }
  return survivors;
}

// Drops the samples that do not pay and tells the share of the frame's time for the rest.
double Worker::choose(const FrameOrder& order, CastResult& cast, bool eye_rests) {
  std::vector<Sample>& survivors = cast.survivors;
  const auto of_eye =
      std::count_if(survivors.begin(), survivors.end(), [](const Sample& s) { return s.ray.eye_dependent; });
  const double count = static_cast<double>(std::max<std::size_t>(survivors.size(), 1));
  const CastSurvivors known{
      cast.moved, static_cast<double>(of_eye) / count,
      static_cast<double>(in_region_) / static_cast<double>(mesh_.region().pixel_count())};
  CastLimits limits = cast_limits_at_rest(known);
  if (!eye_rests) {
    CastEvidence evidence = order.evidence;
    evidence += own_evidence_;
    const int life = cast_life(evidence, known.eye_dependent);
    std::erase_if(survivors, [&](const Sample& s) { return order.number - s.frame > life; });
    try_some(order, survivors);
    evidence += report_.evidence;
    limits = cast_limits(evidence, known);
  }
  std::erase_if(survivors, [&](const Sample& s) {
    return s.frame != order.number && (limits.share == 0 || (s.ray.eye_dependent && !limits.eye_dependent));
  });
  if (limits.one_a_pixel) keep_youngest_of_pixels(survivors);
  return limits.share;
}

// Whether casting pays is found out by asking a few samples: whether they are seen and, where their colour
// depends on the eye, what it is now. Those become samples of this frame.
void Worker::try_some(const FrameOrder& order, std::vector<Sample>& survivors) {
  constexpr std::uint64_t kTriedOneOf = 64;
  for (Sample& s : survivors) {
    if (!is_one_of(s, kTriedOneOf)) continue;
    const bool seen = see(s.ray.hit, s.ray.at_infinity);
    ++report_.evidence.asked;
    report_.evidence.hidden += !seen;
    if (!seen || !s.ray.eye_dependent) continue;
    const Color stale = s.ray.color;
    s = trace(order, s.x, s.y);
    ++report_.samples_new;
    ++report_.evidence.stale;
    report_.evidence.stale_error += display_error(stale, s.ray.color);
  }
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
  if (order.deadline_s > 0) keep_youngest(own, clock_->affordable(Work::kKeptSample, kCastShare));
  for (const Sample& s : own) put_back(s);
  report_.cpu_ms.casting += clock_->lap_ms();
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
  // What was said before is heard before: a stance counts on the gifts that were sent ahead of it.
  take_in(inbox_.take_bundles([&](const Inbox::Arrived& a) { return a.bundle.frame_index < order.index; }));
  const std::vector<Inbox::Arrived> bundles = inbox_.take_bundles(of_this_round);
  for (const Inbox::Arrived& arrived : bundles) stance_.hear(arrived.from, arrived.bundle.stance);
  for (const Inbox::Arrived& arrived : bundles) take_in_seeds(arrived);
  for (const Inbox::Arrived& arrived : bundles) take_over_survivors(arrived, survivors);
}

// It counts like one traced here: a tile's quality is that of all its samples, and so is what it has taken.
bool Worker::put_back(const Sample& survivor) {
  look_for_messages();
  if (!insert(survivor, {network_.rank(), {}, true})) return false;
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
