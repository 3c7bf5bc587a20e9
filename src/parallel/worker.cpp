#include "parallel/worker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/sampling/seeds.h"

namespace pprt {
namespace {

// A resting camera accumulates no more than this: further samples change a pixel by less than a display step,
// and each costs time in every reconstruction to come.
constexpr std::uint64_t kSamplesPerPixelAtMost = 16;

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
      mesh_(region_of(partition, network.rank()),
            {.learned = settings.learned_weights, .edges = settings.pixel_rule == PixelRule::kEdges}),
      exchange_(partition, network.rank(), seed_pattern(settings.width, settings.height, settings.seed)),
      balancer_(network.rank(), network.size(), partition.grid.tile_count()),
      handshake_(network.size()),
      projected_shapes_(probe_.view),
      anchors_(probe_.primitives),
      peer_done_(static_cast<std::size_t>(network.size()), 0) {
  own_region_changed();
}

void Worker::render(const FrameOrder& order) {
  own_evidence_ = report_.evidence;
  report_ = {};
  frame_index_ = order.index;
  frame_number_ = order.number;
  for (UnderWay& u : under_way_) u.round -= kRoundsPerFrame;  // rounds are counted anew
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
  const double lap = clock_->lap_ms();
  report_.cpu_ms.sampling += lap;
  if (measures_fresh_ && !clock_->in_lockstep()) report_.evidence.fresh_ms = lap;
  reconstruct_and_send(order);
}

// --- Sample ---

void Worker::sample(const FrameOrder& order) {
  const bool free = order.deadline_s == 0;
  const std::size_t begin = mesh_.samples().size();
  measures_fresh_ = false;
  for (int round = kSeedRound + 1;; ++round) {
    clock_->begin_packet(in_region_);
    seek_anchors(order);
    const bool measured = std::exchange(measures_fresh_, clock_->sampling_share() > 0.75);
    if (measures_fresh_ && !measured) report_.cpu_ms.sampling += clock_->lap_ms();
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
    // Where samples have a fixed price, an order that makes them faster has nothing to give.
    if (!free && !clock_->in_lockstep()) mesh_.expect_growth(growth_since(begin));
    if (idle && !traced && !clock_->in_lockstep()) await_news();
  }
}

// How many times as many samples the frame is going to have as there are now: what came since `begin` goes
// on coming.
double Worker::growth_since(std::size_t begin) const {
  const double share = clock_->sampling_share();
  const auto now = static_cast<double>(mesh_.samples().size());
  return 1 + (1 - static_cast<double>(begin) / now) * (1 - share) / share;
}

// Once refinement has found again by itself what it soon finds.
void Worker::seek_anchors(const FrameOrder& order) {
  constexpr double kAfter = 0.1;
  const double share = clock_->sampling_share();
  if (anchors_at_most_ == 0 || share < kAfter) return;
  double most = std::exchange(anchors_at_most_, 0);
  if (order.deadline_s > 0)
    most = std::min(most, kAnchorShare * static_cast<double>(report_.samples_new) / share);
  sought_ = anchors_.unseen(mesh_.samples(), order.camera, mesh_.region(), static_cast<std::size_t>(most));
  std::reverse(sought_.begin(), sought_.end());
}

void Worker::seek_once() {
  const Sample anchor = sought_.back();
  sought_.pop_back();
  if (see(anchor.ray.hit, anchor.ray.at_infinity)) put_back(anchor);
}

// Traces one sample where it is wanted most; false when nothing is. PrimitiveAnchors come first, but not at
// the frame's end, where evidence is taken of what refinement itself wants.
bool Worker::refine_once(const FrameOrder& order) {
  if (in_region_ >= sample_limit_) return false;
  if (!sought_.empty() && !measures_fresh_) {
    seek_once();
    return true;
  }
  const std::optional<Refinement> next = mesh_.next_point();
  if (!next) return false;
  const Sample sample = trace(order, next->point.x, next->point.y);
  if (measures_fresh_) {
    const SampleMesh::Guess guess = mesh_.guess(*next, sample.ray.primitive);
    ++report_.evidence.fresh;
    report_.evidence.fresh_error += guess.area * display_error(sample.ray.color, guess.color);
    report_.evidence.fresh_area += guess.area;
    report_.evidence.fresh_rays += sample.ray.rays;
  }
  insert(sample, {network_.rank(), {}});
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
  const std::vector<TileTransfer> transfers = local ? give_tiles() : std::vector<TileTransfer>();
  const RankProgress progress = local ? balancer_.progress(mesh_, clock_->sampling_share()) : RankProgress();
  const bool tell_progress = local && (clock_->in_lockstep() || round % kPacketsPerProgress == 0);
  clock_->spend(Work::kUpdateRule, exchange_.announce(mesh_));
  link_bytes_ = 0;
  for (int rank = 0; rank < network_.size(); ++rank) {
    if (rank == network_.rank()) continue;
    std::vector<Sample> samples = exchange_.take_outbox(rank);
    const bool neighbour = tell_progress && std::binary_search(exchange_.neighbours().begin(),
                                                               exchange_.neighbours().end(), rank);
    const bool concerned =
        !samples.empty() || !transfers.empty() || neighbour || to_all || handshake_.owes_word(rank);
    if (!concerned && !clock_->in_lockstep()) continue;
    send_bundle(rank, {order.index, epoch_, round, done_, 0, progress, {}, transfers, std::move(samples)},
                concerned);
  }
}

// Counted are the bytes of those that would be sent if ranks did not wait for each other, too.
void Worker::send_bundle(int rank, Bundle bundle, bool counts) {
  bundle.handshake = handshake_.tell(rank);
  // What one rank sends in a round goes through its link one after the other.
  link_bytes_ += static_cast<double>(bundle.samples.size() * kSampleBytes);
  const Machine& machine = settings_.machine;
  bundle.rounds_under_way =
      clock_->rounds_under_way(machine.latency_s + link_bytes_ / machine.bytes_per_second);
  clock_->spend(Work::kSentSample, bundle.samples.size());
  Bytes bytes = encode(bundle);
  const std::size_t of_transfers = bundle.transfers.size() * sizeof(TileTransfer);
  if (counts) {
    const std::size_t of_samples = bundle.samples.size() * kSampleBytes;
    report_.bytes_samples += of_samples;
    report_.bytes_balance += of_transfers;
    report_.bytes_progress += bytes.size() - of_samples - of_transfers;
  }
  network_.send(rank, Tag::kBundle, std::move(bytes));
}

void Worker::receive_bundles(const FrameOrder& order, int round) {
  if (clock_->in_lockstep()) {
    const auto of_this_round = [&](const Inbox::Arrived& a) {
      return a.bundle.frame_index == order.index && a.bundle.round == round;
    };
    const auto expected = static_cast<std::size_t>(network_.size() - 1);
    await([&] { return inbox_.count_bundles(of_this_round) >= expected; });
    take_in(arrived_by(round, inbox_.take_bundles(of_this_round)));
    return;
  }
  inbox_.pump();
  // Those of a later triangulation wait; those of an earlier one are of no more use.
  const auto due = [&](const Inbox::Arrived& a) {
    return a.bundle.epoch <= epoch_ && a.bundle.frame_index <= order.index;
  };
  take_in(inbox_.take_bundles(due));
}

// Lockstep: the round's bundles, their samples replaced by those that arrive in this round, whenever they
// were sent. What else they tell is small and is taken in at once.
std::vector<Inbox::Arrived> Worker::arrived_by(int round, std::vector<Inbox::Arrived> bundles) {
  for (Inbox::Arrived& a : bundles) {
    if (a.bundle.rounds_under_way == 0) continue;
    under_way_.push_back({a.from, round + a.bundle.rounds_under_way, std::move(a.bundle.samples)});
    a.bundle.samples.clear();
  }
  for (UnderWay& u : under_way_) {
    if (u.round > round) continue;
    const auto bundle = std::find_if(bundles.begin(), bundles.end(),
                                     [&](const Inbox::Arrived& a) { return a.from == u.from; });
    bundle->bundle.samples.insert(bundle->bundle.samples.end(), u.samples.begin(), u.samples.end());
  }
  std::erase_if(under_way_, [round](const UnderWay& u) { return u.round <= round; });
  return bundles;
}

// First who owns what from now on, then the samples: those that fall to new tiles are refined at once.
void Worker::take_in(const std::vector<Inbox::Arrived>& bundles) {
  std::vector<TileTransfer> transfers;
  for (const Inbox::Arrived& arrived : bundles) {
    const Bundle& bundle = arrived.bundle;
    transfers.insert(transfers.end(), bundle.transfers.begin(), bundle.transfers.end());
    handshake_.hear(arrived.from, bundle.handshake);
    const bool transfer = std::any_of(bundle.transfers.begin(), bundle.transfers.end(),
                                      [&](const TileTransfer& g) { return g.owner == network_.rank(); });
    if (transfer) handshake_.took(arrived.from);
    if (bundle.frame_index != frame_index_) continue;
    balancer_.heard(arrived.from, bundle.progress);
    peer_done_[static_cast<std::size_t>(arrived.from)] = bundle.done;
  }
  apply(transfers);
  for (const Inbox::Arrived& arrived : bundles) {
    if (arrived.bundle.epoch != epoch_) continue;
    for (const TileTransfer& transfer : arrived.bundle.transfers) {
      if (transfer.owner == network_.rank()) exchange_.pass_on(mesh_, transfer.tile);
    }
    if (arrived.bundle.round == kSeedRound && arrived.bundle.frame_index == epoch_) {
      take_in_late_seeds(arrived);
      continue;
    }
    for (const Sample& s : arrived.bundle.samples) {
      ++(insert(s, {arrived.from, {}}) ? report_.samples_received : report_.samples_known);
    }
  }
}

// Tiles for a neighbour that is ahead, already made the taker's here. Where a number of samples is the goal
// each rank takes the share of its area, which stays as it is. Under a resting camera a region with more
// samples than pixels is fine enough, and its samples are too many to hand over.
std::vector<TileTransfer> Worker::give_tiles() {
  if (epoch_ != frame_index_ && in_region_ > mesh_.region().pixel_count()) return {};
  // Where most samples were cast each tile has so many from the start that transfers cost more than they
  // bring, but for the first ones; and a new cut costs hardly anything there, for the samples move anyhow.
  const bool mostly_cast = epoch_ == frame_index_ && 2 * report_.samples_cast > in_region_;
  if (mostly_cast && (settings_.balance == BalanceMode::kCombined || clock_->sampling_share() > 0.25))
    return {};
  if (!balancer_.is_time_to_give(clock_->sampling_share()) || settings_.stop.samples > 0) return {};
  // What the taker must take in may cost it a tenth of the frame.
  const double most_samples = settings_.frames_per_second > 0
                                  ? static_cast<double>(clock_->affordable(Work::kReceivedSample, 0.1))
                                  : std::numeric_limits<double>::infinity();
  handshake_.decide(balancer_.wants_to_give(mesh_, exchange_.neighbours(), handshake_.is_giving()));
  std::vector<TileTransfer> transfers = balancer_.give(mesh_, exchange_, handshake_, most_samples);
  for (const TileTransfer& transfer : transfers) given_.push_back(transfer.tile);
  report_.tiles_given += transfers.size();
  apply(transfers);
  return transfers;
}

// Makes transfers true here, those that are news.
void Worker::apply(std::span<const TileTransfer> transfers) {
  if (transfers.empty()) return;
  Partition next = exchange_.partition();
  bool changed = false, own_changed = false;
  for (const TileTransfer& transfer : transfers) {
    const auto tile = static_cast<std::size_t>(transfer.tile);
    if (tile >= next.owner.size() || transfer.owner < 0 || transfer.owner >= next.ranks) {
      throw ProtocolError("a tile was given that is none, or to nobody");
    }
    if (transfer.version <= next.version[tile]) continue;
    changed = true;
    own_changed = own_changed || next.owner[tile] == network_.rank() || transfer.owner == network_.rank();
    if (transfer.owner == network_.rank()) balancer_.take(transfer);
    next.owner[tile] = transfer.owner;
    next.version[tile] = transfer.version;
  }
  if (!changed) return;
  exchange_.repartition(mesh_, next);
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
  reconstruct(mesh_, bounds, pixels_, buffers_, settings_.pixel_rule,
              probe_.view ? &projected_shapes_ : nullptr);
  clock_->spend(Work::kPixel, mesh_.region().pixel_count());
  report_.cpu_ms.reconstruction = clock_->lap_ms();

  PixelMessage message;
  message.frame_index = order.index;
  message.tiles = balancer_.report(mesh_);
  // In lockstep the new owners certainly have them.
  if (!clock_->in_lockstep()) message.given = given_;
  append_rgb(pixels_, grid, mesh_.region().tiles(), message.rgb);
  append_rgb(pixels_, grid, message.given, message.rgb);
  report_.bytes_pixels = message.rgb.size() * sizeof(float);
  report_.bytes_balance += message.tiles.size() * sizeof(TileReport);
  if (settings_.report_samples) message.samples = own_samples();
  message.report = finish_report();
  network_.send(0, Tag::kPixels, encode(message));
  clock_->end_frame(message.report.cpu_ms.reconstruction);
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
  account_for(sample);
  return sample;
}

// What the sample is worth to its tile, in estimates of what the tile will take.
void Worker::account_for(const Sample& sample) {
  balancer_.paid(mesh_.region().grid().tile_at(sample.x, sample.y),
                 static_cast<double>(price(Work::kRay) * sample.ray.rays + price(Work::kOwnSample)));
}

bool Worker::insert(const Sample& sample, const Insertion& how) {
  return note_insertion(sample, how, mesh_.insert(sample));
}

bool Worker::note_insertion(const Sample& sample, const Insertion& how, bool is_new) {
  const bool own = how.from == network_.rank();
  clock_->spend(!own ? Work::kReceivedSample : how.kept ? Work::kKeptSample : Work::kOwnSample, 1);
  if (!own) balancer_.received(static_cast<double>(price(Work::kReceivedSample)));
  if (!is_new) return false;
  in_region_ += mesh_.region().owns_point(sample.x, sample.y);
  if (!how.seed) {
    exchange_.inserted(how.from);
  } else if (own) {
    exchange_.seeded_here(mesh_, *how.seed);
  } else {
    exchange_.seeded_elsewhere(how.from);
  }
  return true;
}

// One short wait, at most, for messages: what has come is dealt with by the caller's next round.
void Worker::await_news() {
  const double began = monotonic_seconds();
  if (!inbox_.pump()) rest_briefly();
  note_rest(monotonic_seconds() - began);
}

void Worker::await(const std::function<bool()>& arrived) {
  const double began = monotonic_seconds();
  inbox_.pump();
  while (!arrived()) {
    if (!inbox_.pump()) rest_briefly();
  }
  if (!clock_->in_lockstep()) note_rest(monotonic_seconds() - began);
}

void Worker::note_rest(double seconds) {
  report_.cpu_ms.idle += 1e3 * seconds;
  clock_->rested(seconds);
}

}  // namespace pprt
