#include "parallel/worker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/seeds.h"

namespace pprt {
namespace {

// A resting camera accumulates no more than this: further samples change a pixel by less than a display step,
// and each costs time in every reconstruction to come.
constexpr std::uint64_t kSamplesPerPixelAtMost = 16;

// Wall clock: the share of a frame's period that a rank waits for its neighbours' seeds before it goes on
// without.
constexpr double kSeedPatience = 0.1;

// A rank tells its progress to its neighbours after so many packets, if there is no sample to tell before.
constexpr int kPacketsPerProgress = 4;

bool is_finite(const Color& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

void append_rgb(const RegionPixels& pixels, const TileGrid& grid, std::span<const int> tiles,
                std::vector<float>& rgb) {
  for (const int tile : tiles) {
    const PixelRect rect = grid.pixels(tile);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) {
        const Color& c = pixels.at(x, y);
        rgb.insert(rgb.end(), {c.x, c.y, c.z});
      }
    }
  }
}

PixelRect united(const PixelRect& a, const PixelRect& b) {
  if (a.area() == 0) return b;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

Worker::Worker(Communicator& network, Inbox& inbox, const SessionSettings& settings,
               const Partition& partition, Probe probe, std::unique_ptr<FrameClock> clock)
    : network_(network),
      inbox_(inbox),
      settings_(settings),
      probe_(std::move(probe)),
      clock_(std::move(clock)),
      mesh_(region_of(partition, network.rank())),
      exchange_(partition, network.rank()),
      balancer_(network.rank(), network.size(), partition.grid.tile_count()),
      peer_done_(static_cast<std::size_t>(network.size()), 0) {
  own_region_changed();
}

void Worker::render(const FrameOrder& order) {
  report_ = {};
  frame_index_ = order.index;
  rays_before_ = probe_.counts();
  done_ = false;
  given_.clear();
  std::fill(peer_done_.begin(), peer_done_.end(), std::uint8_t{0});
  await([&] { return clock_->may_begin(order); });
  if (is_past(order)) {
    leave_out(order);
    return;
  }
  hear_gifts(order);
  clock_->begin_frame(order);
  clock_->lap_ms();
  prepare(order);
  sample(order);
  report_.cpu_ms.sampling += clock_->lap_ms();
  reconstruct_and_send(order);
}

// --- Prepare ---

void Worker::prepare(const FrameOrder& order) {
  probe_.look_from(order.camera);
  const bool new_partition = !order.owners.empty();
  const Carry carry = carried_into(order);
  const Missed missed = std::exchange(missed_, {});
  balancer_.begin_frame(carry != Carry::kAccumulate || missed.triangulation);
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
  if (carry != Carry::kNothing && !missed.cut) survivors = cast(order);
  report_.cpu_ms.casting += clock_->lap_ms();
  if (new_partition) adopt_partition(order, false);

  begin_triangulation(order.index);
  trace_seeds(order, order.number);
  settle(order, survivors);
}

void Worker::begin_triangulation(int epoch) {
  mesh_.clear();
  exchange_.clear();
  epoch_ = epoch;
  in_region_ = 0;
}

// The master has cut the image anew. The samples of tiles that go to another rank are told to it if they are
// kept.
void Worker::adopt_partition(const FrameOrder& order, bool keep_samples) {
  Partition next = exchange_.partition();
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
  exchange_.repartition(next);
  own_region_changed();
}

// What the ranks tell each other before the first sample of a frame that keeps its triangulation but not its
// partition.
void Worker::send_handed_over(const FrameOrder& order) {
  send_bundles(order, kSeedRound, false);
  receive_bundles(order, kSeedRound);
}

std::vector<Sample> Worker::cast(const FrameOrder& order) {
  CastSettings cast_settings;
  cast_settings.method = order.carry == Carry::kCastVerified ? CastMethod::kVerified : CastMethod::kPaper;
  clock_->spend(Work::kCastSample, in_region_);
  if (cast_settings.method == CastMethod::kVerified) clock_->spend(Work::kRay, in_region_);
  std::vector<Sample> survivors =
      cast_samples(mesh_, order.camera, order.number, cast_settings, probe_.visible).survivors;
  // Putting them back may take half of a frame at most; the rest is for new samples.
  if (order.deadline_s > 0) keep_youngest(survivors, clock_->affordable(Work::kOwnSample, 0.5));
  return survivors;
}

// The seeds of the frame of that number, seen from this one's camera.
void Worker::trace_seeds(const FrameOrder& order, int number) {
  const std::vector<Vec2d> seeds = seed_points(settings_.width, settings_.height, settings_.seed, number);
  constexpr std::size_t kCorners = 4;  // every mesh needs them, so that its hull is the image
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const bool own = mesh_.region().owns_point(seeds[i].x, seeds[i].y);
    if (i >= kCorners && !own) continue;
    // A foreign corner is its owner's sample, which tells it to others and counts it.
    const int owner = exchange_.owner_of(seeds[i].x, seeds[i].y);
    insert(trace(order, seeds[i].x, seeds[i].y), {owner, true});
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
    if (samples.empty() && !peer && !clock_->in_lockstep()) continue;
    send_bundle(rank, {order.index, epoch_, kSeedRound, false, {}, {}, std::move(samples)});
  }
  receive_seeds(order);
  report_.cpu_ms.sampling += clock_->lap_ms();
  for (const Sample& s : own) {
    if (insert(s, {network_.rank(), false})) ++report_.samples_cast;
  }
  report_.cpu_ms.casting += clock_->lap_ms();
}

void Worker::receive_seeds(const FrameOrder& order) {
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
  const std::vector<Inbox::Arrived> bundles = inbox_.take_bundles(of_this_round);
  for (const Inbox::Arrived& arrived : bundles) take_in_seeds(arrived);
  for (const Inbox::Arrived& arrived : bundles) take_in_survivors(arrived);
}

// What comes before a fresh triangulation's first round and lies elsewhere is another rank's seed.
void Worker::take_in_seeds(const Inbox::Arrived& arrived) {
  for (const Sample& s : arrived.bundle.samples) {
    if (mesh_.region().owns_point(s.x, s.y)) continue;
    ++(insert(s, {arrived.from, true}) ? report_.samples_received : report_.samples_known);
  }
}

// And what lies in the own region is a survivor that landed here. Who hands it over keeps none: it is this
// rank's to tell, to the former owner too.
void Worker::take_in_survivors(const Inbox::Arrived& arrived) {
  for (const Sample& s : arrived.bundle.samples) {
    if (!mesh_.region().owns_point(s.x, s.y)) continue;
    const bool inserted = insert(s, {network_.rank(), false});
    ++(inserted ? report_.samples_received : report_.samples_known);
    report_.samples_cast += inserted;
  }
}

// --- Sample ---

void Worker::sample(const FrameOrder& order) {
  const bool free = order.deadline_s == 0;
  for (int round = kSeedRound + 1;; ++round) {
    clock_->begin_packet();
    bool idle = false, traced = false;
    while (!idle && !clock_->packet_over()) {
      idle = (free && goal_reached()) || !refine_once(order);
      traced = traced || !idle;
    }
    // A goal counts when it still holds after what the others have sent: not in the round that reached it.
    const bool was_done = std::exchange(done_, free && idle && !traced);
    send_bundles(order, round, done_ != was_done);
    receive_bundles(order, round);
    if (clock_->sampling_over() || (free && all_done())) return;
    if (idle && !traced && !clock_->in_lockstep()) await_news();
  }
}

// Traces one sample where it is wanted most; false when nothing is.
bool Worker::refine_once(const FrameOrder& order) {
  if (in_region_ >= sample_limit_) return false;
  const std::optional<Vec2d> point = mesh_.next_point();
  if (!point) return false;
  insert(trace(order, point->x, point->y), {network_.rank(), false});
  ++report_.samples_new;
  return true;
}

bool Worker::goal_reached() const {
  const StopRules& stop = settings_.stop;
  return (stop.samples > 0 && in_region_ >= sample_share_) ||
         (stop.quality > 0 && mesh_.refinement() <= stop.quality) ||
         (stop.seconds > 0 && clock_->frame_seconds() >= stop.seconds);
}

bool Worker::all_done() const {
  const auto others = std::count(peer_done_.begin(), peer_done_.end(), std::uint8_t{1});
  return done_ && others == network_.size() - 1;
}

void Worker::send_bundles(const FrameOrder& order, int round, bool to_all) {
  const bool local = settings_.balance == BalanceMode::kLocal || settings_.balance == BalanceMode::kCombined;
  const std::vector<TileGrant> grants = local ? give_tiles() : std::vector<TileGrant>();
  const RankProgress progress = local ? balancer_.progress(mesh_) : RankProgress();
  const bool tell_progress = local && round % kPacketsPerProgress == 0;
  for (int rank = 0; rank < network_.size(); ++rank) {
    if (rank == network_.rank()) continue;
    std::vector<Sample> samples = exchange_.take_outbox(rank);
    const bool neighbour = tell_progress && std::binary_search(exchange_.neighbours().begin(),
                                                               exchange_.neighbours().end(), rank);
    if (samples.empty() && grants.empty() && !neighbour && !to_all && !clock_->in_lockstep()) continue;
    send_bundle(rank, {order.index, epoch_, round, done_, progress, grants, std::move(samples)});
  }
}

void Worker::send_bundle(int rank, const Bundle& bundle) {
  clock_->spend(Work::kSentSample, bundle.samples.size());
  Bytes bytes = encode(bundle);
  const std::size_t of_grants = bundle.grants.size() * sizeof(TileGrant);
  report_.bytes_progress += sizeof(RankProgress);
  report_.bytes_balance += of_grants;
  report_.bytes_samples += bytes.size() - sizeof(RankProgress) - of_grants;
  network_.send(rank, Tag::kBundle, std::move(bytes));
}

void Worker::receive_bundles(const FrameOrder& order, int round) {
  if (clock_->in_lockstep()) {
    const auto of_this_round = [&](const Inbox::Arrived& a) {
      return a.bundle.frame_index == order.index && a.bundle.round == round;
    };
    const auto expected = static_cast<std::size_t>(network_.size() - 1);
    await([&] { return inbox_.count_bundles(of_this_round) >= expected; });
    take_in(inbox_.take_bundles(of_this_round));
    return;
  }
  inbox_.pump();
  // Those of a later triangulation wait; those of an earlier one are of no more use.
  const auto due = [&](const Inbox::Arrived& a) {
    return a.bundle.epoch <= epoch_ && a.bundle.frame_index <= order.index;
  };
  take_in(inbox_.take_bundles(due));
}

// First who owns what from now on, then the samples: those that fall to new tiles are refined at once.
void Worker::take_in(const std::vector<Inbox::Arrived>& bundles) {
  std::vector<TileGrant> grants;
  for (const Inbox::Arrived& arrived : bundles) {
    const Bundle& bundle = arrived.bundle;
    grants.insert(grants.end(), bundle.grants.begin(), bundle.grants.end());
    if (bundle.frame_index != frame_index_) continue;
    balancer_.heard(arrived.from, bundle.progress);
    peer_done_[static_cast<std::size_t>(arrived.from)] = bundle.done;
  }
  apply(grants);
  for (const Inbox::Arrived& arrived : bundles) {
    if (arrived.bundle.epoch != epoch_) continue;
    if (arrived.bundle.round == kSeedRound && arrived.bundle.frame_index == epoch_) {
      take_in_seeds(arrived);  // too late to be waited for
      take_in_survivors(arrived);
      continue;
    }
    for (const Sample& s : arrived.bundle.samples) {
      ++(insert(s, {arrived.from, false}) ? report_.samples_received : report_.samples_known);
    }
  }
}

// Tiles for a neighbour that is ahead, already made the taker's here. Where a number of samples is the goal
// each rank takes the share of its area, which stays as it is. Under a resting camera a region with more
// samples than pixels is fine enough, and its samples are too many to hand over.
std::vector<TileGrant> Worker::give_tiles() {
  if (epoch_ != frame_index_ && in_region_ > mesh_.region().pixel_count()) return {};
  if (!clock_->time_for_gifts() || settings_.stop.samples > 0) return {};
  // What the taker must take in may cost it a tenth of the frame.
  const double most_samples = settings_.frames_per_second > 0
                                  ? static_cast<double>(clock_->affordable(Work::kReceivedSample, 0.1))
                                  : std::numeric_limits<double>::infinity();
  std::vector<TileGrant> grants = balancer_.give(mesh_, exchange_, most_samples);
  for (const TileGrant& grant : grants) given_.push_back(grant.tile);
  report_.tiles_given += grants.size();
  apply(grants);
  return grants;
}

// Makes grants true here, those that are news.
void Worker::apply(std::span<const TileGrant> grants) {
  if (grants.empty()) return;
  Partition next = exchange_.partition();
  bool changed = false, own_changed = false;
  for (const TileGrant& grant : grants) {
    const auto tile = static_cast<std::size_t>(grant.tile);
    if (tile >= next.owner.size() || grant.owner < 0 || grant.owner >= next.ranks) {
      throw ProtocolError("a tile was given that is none, or to nobody");
    }
    if (grant.version <= next.version[tile]) continue;
    changed = true;
    own_changed = own_changed || next.owner[tile] == network_.rank() || grant.owner == network_.rank();
    if (grant.owner == network_.rank()) balancer_.take(grant);
    next.owner[tile] = grant.owner;
    next.version[tile] = grant.version;
  }
  if (!changed) return;
  exchange_.repartition(next);
  if (own_changed) own_region_changed();
}

void Worker::own_region_changed() {
  mesh_.set_region(region_of(exchange_.partition(), network_.rank()));
  const Region& region = mesh_.region();
  const std::span<const Sample> samples = mesh_.samples();
  in_region_ = static_cast<std::uint64_t>(std::count_if(
      samples.begin(), samples.end(), [&](const Sample& s) { return region.owns_point(s.x, s.y); }));
  const std::uint64_t own = region.pixel_count();
  const auto all = static_cast<std::uint64_t>(settings_.width) * static_cast<std::uint64_t>(settings_.height);
  sample_share_ = (settings_.stop.samples * own + all - 1) / all;
  sample_limit_ = kSamplesPerPixelAtMost * own;
  clock_->region_changed(own);
}

// --- Reconstruct and report ---

void Worker::reconstruct_and_send(const FrameOrder& order) {
  report_.sampling_ended_s = clock_->sampling_end_seconds();
  const TileGrid& grid = mesh_.region().grid();
  PixelRect bounds = mesh_.region().bounds();
  for (const int tile : given_) bounds = united(bounds, grid.pixels(tile));
  reconstruct(mesh_, bounds, pixels_, buffers_);
  clock_->spend(Work::kPixel, mesh_.region().pixel_count());
  report_.cpu_ms.reconstruction = clock_->lap_ms();

  PixelMessage message;
  message.frame_index = order.index;
  message.tiles = balancer_.report(mesh_);
  // In lockstep the new owners certainly have them.
  if (!clock_->in_lockstep()) message.given = given_;
  append_rgb(pixels_, grid, mesh_.region().tiles(), message.rgb);
  append_rgb(pixels_, grid, message.given, message.rgb);
  report_.bytes_pixels = message.rgb.size() * sizeof(float) + message.tiles.size() * sizeof(TileReport);
  if (settings_.report_samples) message.samples = own_samples();
  message.report = finish_report();
  network_.send(0, Tag::kPixels, encode(message));
  clock_->end_frame();
}

std::vector<Sample> Worker::own_samples() const {
  std::vector<Sample> own;
  for (const Sample& s : mesh_.samples()) {
    if (mesh_.region().owns_point(s.x, s.y)) own.push_back(s);
  }
  return own;
}

RankReport Worker::finish_report() {
  report_.samples_in_region = in_region_;
  report_.refinement = mesh_.refinement();
  for (const int tile : mesh_.region().tiles()) {
    report_.triangles_in_region +=
        static_cast<std::uint64_t>(mesh_.tile_weights()[static_cast<std::size_t>(tile)].triangles);
  }
  report_.rays = probe_.counts() - rays_before_;
  report_.finished_s = clock_->frame_seconds();
  return report_;
}

// --- Common ---

// The one gate for colours that are no numbers: counted, and black from here on.
Sample Worker::trace(const FrameOrder& order, double x, double y) {
  Sample sample;
  sample.x = x;
  sample.y = y;
  sample.frame = order.number;
  sample.id = (static_cast<SampleId>(network_.rank()) << 40) | next_id_++;
  sample.ray = probe_.trace(x, y);
  if (!is_finite(sample.ray.color)) {
    ++report_.non_finite;
    sample.ray.color = Color(0, 0, 0);
  }
  clock_->spend(Work::kRay, sample.ray.rays);
  balancer_.paid(mesh_.region().grid().tile_at(x, y),
                 static_cast<double>(price(Work::kRay) * sample.ray.rays + price(Work::kOwnSample)));
  return sample;
}

bool Worker::insert(const Sample& sample, const Insertion& how) {
  const bool own = how.from == network_.rank();
  clock_->spend(own ? Work::kOwnSample : Work::kReceivedSample, 1);
  if (!mesh_.insert(sample)) return false;
  in_region_ += mesh_.region().owns_point(sample.x, sample.y);
  if (!how.is_seed) {
    exchange_.inserted(mesh_, how.from);
  } else if (own) {
    exchange_.seeded_here(mesh_);
  } else {
    exchange_.seeded_elsewhere(how.from);
  }
  return true;
}

// One short wait, at most, for messages: what has come is dealt with by the caller's next round.
void Worker::await_news() {
  const double began = monotonic_seconds();
  if (!inbox_.pump()) rest_briefly();
  report_.cpu_ms.idle += 1e3 * (monotonic_seconds() - began);
}

void Worker::await(const std::function<bool()>& arrived) {
  const double began = monotonic_seconds();
  inbox_.pump();
  while (!arrived()) {
    if (!inbox_.pump()) rest_briefly();
  }
  if (!clock_->in_lockstep()) report_.cpu_ms.idle += 1e3 * (monotonic_seconds() - began);
}

}  // namespace pprt
