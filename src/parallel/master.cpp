#include "parallel/master.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "parallel/balance/global_balance.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/clock/work_units.h"

namespace pprt {
namespace {

// The share of a period that follows sampling, before any frame has shown it.
constexpr double kFirstGuess = 0.35;

// How many frames may be ordered and not yet delivered.
constexpr std::size_t kMostIncompleteFrames = 4;

}  // namespace

Master::Master(Communicator& network, const SessionSettings& settings, const Partition& partition,
               double ranks_per_core, CameraSource source, FrameSink sink, std::function<double()> now)
    : network_(network),
      settings_(settings),
      partition_(partition),
      ranks_per_core_(ranks_per_core),
      source_(std::move(source)),
      sink_(std::move(sink)),
      now_(std::move(now)),
      keeps_deadlines_(settings.clock == ClockKind::kWall && settings.frames_per_second > 0),
      shown_(partition.grid) {}

bool Master::may_begin(int index) const {
  if (delivered_ >= index) return true;
  // An order must not depend on what happens to have come: the frame before is whole, or will be without a
  // further order.
  if (settings_.clock == ClockKind::kWork) return false;
  // Who prepares a frame cannot deliver one. Where ranks share cores nobody begins before that deadline
  // anyway.
  return !keeps_deadlines_ || (ranks_per_core_ <= 1 && sequence_s() < deadline_s(index - 1));
}

void Master::begin_sequence(double start_s) {
  start_s_ = start_s;
  order_next();
}

void Master::frame_begun() {
  order_is_due_ = true;
  order_if_due();
}

// Where all ranks are waited for, one that falls behind holds back the orders: its frames would pile up.
void Master::order_if_due() {
  if (!order_is_due_ || assemblies_.size() >= kMostIncompleteFrames) return;
  order_is_due_ = false;
  order_next();
}

void Master::handle(const Message& message) {
  const PixelMessage pixels = decode_pixels(message.payload);
  const auto found = assemblies_.find(pixels.frame_index);
  if (found == assemblies_.end()) {
    handle_overdue(message.from, pixels);
    return;
  }
  Assembly& assembly = found->second;
  const auto rank = static_cast<std::size_t>(message.from);
  if (std::exchange(assembly.has_come[rank], std::uint8_t{1}) != 0) throw ProtocolError("pixels came twice");
  assembly.picture.paste(message.from, pixels);
  assembly.ranks[rank] = pixels.report;
  assembly.tiles[rank] = pixels.tiles;
  assembly.samples.insert(assembly.samples.end(), pixels.samples.begin(), pixels.samples.end());
  assembly.after_sampling_s = std::max(assembly.after_sampling_s, after_sampling_s(pixels.report));
  --assembly.missing;
  while (!assemblies_.empty() && assemblies_.begin()->second.missing == 0) deliver_first();
}

// The frame has not waited for these pixels; where nothing newer is shown they will fill the next gap. What
// they tell of the time a frame needs counts, unless it is more than a period: then the rank has stood still.
void Master::handle_overdue(int from, const PixelMessage& pixels) {
  if (!keeps_deadlines_ || pixels.frame_index < 0 || pixels.frame_index >= next_index_) {
    throw ProtocolError("pixels came for a frame that was not ordered");
  }
  shown_.paste(from, pixels);
  ++overdue_pixels_;
  if (sequence_s() < deadline_s(pixels.frame_index + 1)) learn_reserve(after_sampling_s(pixels.report));
}

void Master::keep_deadlines() {
  if (!keeps_deadlines_) return;
  const double now_s = sequence_s();
  for (auto& [index, assembly] : assemblies_) {
    if (!assembly.overdue_since_s && now_s >= assembly.order.deadline_s) assembly.overdue_since_s = now_s;
  }
  while (!assemblies_.empty() && is_due(assemblies_.begin()->second)) deliver_first();
}

bool Master::is_due(const Assembly& assembly) const {
  if (assembly.missing == 0) return true;
  if (!assembly.overdue_since_s || delivered_ == 0) return false;
  return sequence_s() >= *assembly.overdue_since_s + kGraceSeconds;
}

void Master::deliver_first() {
  const auto first = assemblies_.begin();
  deliver(first->second);
  assemblies_.erase(first);
  order_if_due();
}

void Master::order_next() {
  if (ended_) return;
  FrameOrder order;
  const std::optional<FrameRequest> request = source_(next_index_);
  if (request) {
    order.index = next_index_++;
    order.number = request->number;
    order.cut = request->cut;
    order.carry = carry_into(*request);
    order.camera = request->camera;
    if (order.carry == Carry::kNothing) evidence_ = {}, evidence_since_ = order.index;
    order.evidence = evidence_;
    if (settings_.frames_per_second > 0) {
      order.deadline_s =
          deadline_s(order.index + (settings_.clock == ClockKind::kWork ? request->left_out : 0));
    }
    order.reserve_s = reserve_s();
    // Cast samples are put back anyhow, by whose they are now.
    const bool hands_over = order.carry == Carry::kAccumulate && settings_.keep_samples;
    if (hands_over && !can_afford_to_hand_over()) next_owners_.clear();
    if (!next_owners_.empty()) ++generation_;
    order.owners = std::exchange(next_owners_, {});
    order.generation = generation_;
    Assembly& assembly = assemblies_.emplace(order.index, start_assembly(order)).first->second;
    // Rank 0 was away for so long that nobody can carry this order out in time.
    if (keeps_deadlines_ && sequence_s() >= order.deadline_s + kGraceSeconds) {
      assembly.overdue_since_s = order.deadline_s;
    }
    before_ = request;
  } else {
    order.end = ended_ = true;
  }
  for (int rank = 0; rank < network_.size(); ++rank) {
    order.tiles.clear();
    for (std::size_t tile = 0; tile < order.owners.size(); ++tile) {
      if (order.owners[tile] == rank) order.tiles.push_back(found_[tile]);
    }
    network_.send(rank, Tag::kFrameOrder, encode(order));
  }
}

Carry Master::carry_into(const FrameRequest& request) const {
  if (!before_ || request.cut || request.carries_nothing || settings_.cast == CastChoice::kOff)
    return Carry::kNothing;
  if (request.camera == before_->camera) return Carry::kAccumulate;
  switch (settings_.cast) {
    case CastChoice::kPaper:
      return Carry::kCastPaper;
    case CastChoice::kVerified:
      return Carry::kCastVerified;
    case CastChoice::kAuto:
      return Carry::kCastWherePaying;
    case CastChoice::kOff:
      break;
  }
  return Carry::kNothing;
}

Master::Assembly Master::start_assembly(const FrameOrder& order) const {
  const auto ranks = static_cast<std::size_t>(network_.size());
  return {.order = order,
          .picture = Mosaic(partition_.grid),
          .ranks = std::vector<RankReport>(ranks),
          .tiles = std::vector<std::vector<TileReport>>(ranks),
          .has_come = std::vector<std::uint8_t>(ranks, 0),
          .samples = {},
          .missing = network_.size(),
          .overdue_since_s = {}};
}

// From what the frame's tiles took, the partition for the next order; in combined only where it is worth it.
// A frame that some ranks did not report tells nothing of the balance.
void Master::balance_globally(const Assembly& assembly) {
  const bool always = settings_.balance == BalanceMode::kGlobal;
  if (!always && settings_.balance != BalanceMode::kCombined) return;
  if (network_.size() == 1 || assembly.missing > 0 ||
      (!always && imbalance(assembly.tiles) <= kImbalanceTrigger))
    return;
  next_owners_ =
      bisect(partition_.grid, predicted_costs(partition_.grid, assembly.tiles), network_.size()).owner;
  found_ = tile_estimates(partition_.grid, assembly.tiles);
  handed_over_.assign(assembly.tiles.size(), 0);
  for (std::size_t rank = 0; rank < assembly.tiles.size(); ++rank) {
    for (const TileReport& tile : assembly.tiles[rank]) {
      const auto taker = static_cast<std::size_t>(next_owners_[static_cast<std::size_t>(tile.tile)]);
      // A triangulation has about two triangles a sample.
      if (taker != rank) handed_over_[taker] += 0.5 * tile.triangles;
    }
  }
}

// Whether every rank can take in the samples of its new tiles in a twentieth of a frame: its former
// owner has to look for them, too. A camera that has
// rested for long has more samples than that; then local balancing goes on alone.
bool Master::can_afford_to_hand_over() const {
  if (next_owners_.empty() || settings_.frames_per_second <= 0) return true;
  if (samples_delivered_ >
      static_cast<std::uint64_t>(settings_.width) * static_cast<std::uint64_t>(settings_.height)) {
    return false;  // fine enough as it is
  }
  const double frame_units = settings_.clock == ClockKind::kWork
                                 ? static_cast<double>(settings_.budget_units)
                                 : 1e9 / settings_.frames_per_second / ranks_per_core_;
  const double most = *std::max_element(handed_over_.begin(), handed_over_.end());
  return most * static_cast<double>(price(Work::kReceivedSample)) <= 0.05 * frame_units;
}

void Master::deliver(Assembly& assembly) {
  samples_delivered_ = 0;
  evidence_ = halved(evidence_);
  for (const RankReport& r : assembly.ranks) {
    samples_delivered_ += r.samples_in_region;
    if (assembly.order.index >= evidence_since_) evidence_ += r.evidence;
  }
  balance_globally(assembly);
  FinishedFrame frame;
  if (keeps_deadlines_) {
    if (assembly.missing > 0) frame.stale_tiles = assembly.picture.fill_gaps(shown_);
    shown_ = assembly.picture;
    learn_reserve(assembly.after_sampling_s);
  }
  ++delivered_;
  frame.order = std::move(assembly.order);
  frame.image = assembly.picture.take_image();
  frame.ranks = std::move(assembly.ranks);
  frame.owners = assembly.picture.shown_ranks();
  frame.samples = std::move(assembly.samples);
  for (int rank = 0; rank < network_.size(); ++rank) {
    if (assembly.has_come[static_cast<std::size_t>(rank)] == 0) frame.late_ranks.push_back(rank);
  }
  frame.overdue_pixels = std::exchange(overdue_pixels_, 0);
  frame.global_balance = !frame.order.owners.empty();
  tell_when(frame);
  sink_(std::move(frame));
}

void Master::tell_when(FinishedFrame& frame) const {
  const double period = settings_.frames_per_second > 0 ? 1 / settings_.frames_per_second : 0;
  if (settings_.clock == ClockKind::kWork) {
    double slowest = 0;
    for (const RankReport& r : frame.ranks) slowest = std::max(slowest, r.finished_s);
    const double budget_s = static_cast<double>(settings_.budget_units) / kWorkUnitsPerSecond;
    const auto begun_periods = std::lround(frame.order.deadline_s * settings_.frames_per_second) - 1;
    frame.finished_s = period > 0 ? static_cast<double>(begun_periods) * period + slowest : slowest;
    frame.late_ms = period > 0 ? 1e3 * (slowest - budget_s) : 0;
  } else {
    frame.finished_s = sequence_s();
    frame.late_ms = period > 0 ? 1e3 * (frame.finished_s - frame.order.deadline_s) : 0;
  }
}

// What has passed, now that a rank's pixels are here, since it had to end sampling, but for what
// reconstruction takes where all ranks of a core are at it: that grows with their samples, and a rank leaves
// room for it itself. Of a frame without late ranks it is what the frame needed; one with late ranks needed
// more, which handle_overdue() learns.
double Master::after_sampling_s(const RankReport& report) const {
  const double reconstruction_s = 1e-3 * report.cpu_ms.reconstruction * ranks_per_core_;
  return std::max(0.0, sequence_s() - report.sampling_ended_s - reconstruction_s);
}

void Master::learn_reserve(double after_sampling_s) {
  constexpr std::size_t kRemembered = 12;
  after_sampling_s_.push_back(after_sampling_s);
  if (after_sampling_s_.size() > kRemembered) after_sampling_s_.pop_front();
}

// What ranks leave, besides their own reconstruction, between the end of sampling and the deadline: the worst
// of the last frames and a quarter more; seven tenths where ranks share cores, for those are not punctual. At
// most seven tenths of the period, so that some sampling remains.
double Master::reserve_s() const {
  if (settings_.frames_per_second <= 0) return 0;
  const double period = 1 / settings_.frames_per_second;
  if (after_sampling_s_.empty()) return kFirstGuess * period;
  const double worst = *std::max_element(after_sampling_s_.begin(), after_sampling_s_.end());
  const double careful = ranks_per_core_ > 1 ? 1.7 * worst + 0.001 : 1.25 * worst + 0.0005;
  return std::clamp(careful, 0.0, 0.7 * period);
}

}  // namespace pprt
