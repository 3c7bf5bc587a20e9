#include "parallel/master/master.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "parallel/clock/make_clocks.h"
#include "parallel/exchange/samplers.h"

namespace pprt {
namespace {

// Which rank's message comes first is chance.
std::vector<TransferChoice> in_order(std::vector<TransferChoice> transfers) {
  std::stable_sort(transfers.begin(), transfers.end(), [](const TransferChoice& a, const TransferChoice& b) {
    return std::pair(a.round, a.giver) < std::pair(b.round, b.giver);
  });
  return transfers;
}

}  // namespace

Master::Master(Communicator& network, const SessionSettings& settings, const Partition& partition,
               double ranks_per_core, CameraSource source, FrameSink sink, std::function<double()> now)
    : network_(network),
      settings_(settings),
      grid_(partition.grid),
      clock_(make_delivery_clock(settings, ranks_per_core, std::move(now))),
      reserve_(settings.frames_per_second > 0 ? 1 / settings.frames_per_second : 0, ranks_per_core),
      balancer_(settings, traits_of(settings.sampler), partition.grid, network.size(),
                clock_->units_per_frame()),
      effort_(settings.stop.rmse),
      source_(std::move(source)),
      sink_(std::move(sink)) {}

// --- Orders

void Master::frame_begun() {
  if (!settings_.late_orders) make_order_due();
}

void Master::frame_done() {
  if (settings_.late_orders) make_order_due();
}

void Master::make_order_due() {
  order_is_due_ = true;
  order_if_due();
}

// Where all ranks are waited for, one that falls behind holds back the orders: its frames would pile up.
void Master::order_if_due() {
  constexpr std::size_t kMostPendingFrames = 4;
  if (!order_is_due_ || frames_.size() >= kMostPendingFrames || awaits_reports()) return;
  order_is_due_ = false;
  order_next();
}

// After a camera cut little is known of what tiles cost. The next frames are better ordered a little later,
// with a partition, than at once and without.
bool Master::awaits_reports() const {
  constexpr int kFramesToKnow = 2;
  const bool is_unknown = next_index_ - last_cut_ <= kFramesToKnow;
  return is_unknown && !frames_.empty() && network_.size() > 1 && settings_.frames_per_second > 0 &&
         balancer_.repartitions();
}

void Master::order_next() {
  if (ended_) return;
  const std::optional<FrameRequest> request = source_(next_index_);
  if (!request) {
    ended_ = true;
    FrameOrder order;
    order.end = true;
    send(order);
    return;
  }
  FrameOrder order = make_order(*request);
  PendingFrame frame{.assembly = FrameAssembly(order, grid_, network_.size())};
  // Rank 0 was away for so long that nobody can carry this order out in time.
  if (order.index > 0 && clock_->keeps_deadlines() && clock_->now_s() >= order.deadline_s + kGraceSeconds)
    frame.overdue_since_s = order.deadline_s;
  frames_.emplace(order.index, std::move(frame));
  if (request->cut) last_cut_ = order.index;
  before_ = request;
  ++next_index_;
  send(order);
}

FrameOrder Master::make_order(const FrameRequest& request) {
  FrameOrder order;
  order.index = next_index_;
  order.number = request.number;
  order.cut = request.cut;
  order.carry = carry_into(request);
  order.camera = request.camera;
  order.time = request.time;
  order.report_samples = settings_.report_samples || request.report_samples;
  if (order.carry == Carry::kNothing) evidence_ = {}, evidence_since_ = order.index;
  order.evidence = evidence_;
  if (settings_.frames_per_second > 0) set_times(request, order);
  order.reserve_s = reserve_.reserve_s();
  order.lost = lost_;
  balancer_.add_partition(order);
  return order;
}

// A frame that is good enough early leaves the rest of its period to nobody.
void Master::set_times(const FrameRequest& request, FrameOrder& order) {
  const double period_s = 1 / settings_.frames_per_second;
  further_periods_ += request.periods - 1;
  order.deadline_s = clock_->deadline_s(order.index, request.left_out) + further_periods_ * period_s;
  order.periods = request.periods;
  order.is_awaited = settings_.awaits_all;
  if (settings_.stop.rmse <= 0) return;
  order.effort = effort_.for_frame(order.cut, order.carry == Carry::kAccumulate);
  order.not_before_s = order.deadline_s - order.periods * period_s;
}

Carry Master::carry_into(const FrameRequest& request) const {
  if (!before_ || request.cut || request.carries_nothing || settings_.cast == CastChoice::kOff)
    return Carry::kNothing;
  if (request.camera == before_->camera && !request.moves) return Carry::kAccumulate;
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

void Master::send(const FrameOrder& order) {
  std::vector<Bytes> messages = encode_for_ranks(order, balancer_.estimates_for(order));
  // What is sent to a rank that was given up is dropped.
  for (int rank = 0; rank < network_.size(); ++rank)
    network_.send(rank, Tag::kFrameOrder, std::move(messages[static_cast<std::size_t>(rank)]));
}

// --- Pixels

void Master::handle(const Message& message) {
  if (is_lost(message.from)) return;  // it answers again, too late
  if (message.tag == Tag::kTransfers) return handle_transfers(message);
  const PixelMessage pixels = decode_pixels(message.payload);
  const auto found = frames_.find(pixels.frame_index);
  if (found == frames_.end()) {
    handle_overdue(message.from, pixels);
    return;
  }
  PendingFrame& frame = found->second;
  frame.assembly.add(message.from, pixels);
  if (!pixels.is_last) return;
  frame.after_sampling_s = std::max(frame.after_sampling_s, after_sampling_s(pixels.report));
  while (!frames_.empty() && frames_.begin()->second.assembly.is_whole()) deliver_first();
}

// Those of a frame that has been delivered are of no use any more.
void Master::handle_transfers(const Message& message) {
  TransferMessage transfers = decode_transfers(message.payload);
  const auto found = frames_.find(transfers.frame_index);
  if (found == frames_.end()) return;
  std::vector<TransferChoice>& all = found->second.assembly.transfers;
  std::move(transfers.choices.begin(), transfers.choices.end(), std::back_inserter(all));
}

// Pixels for which the frame has not waited fill the next gap, unless something newer is shown there. The
// time that their frame needed counts, unless it is more than a period: then the rank has stood still.
void Master::handle_overdue(int from, const PixelMessage& pixels) {
  if (!clock_->keeps_deadlines() || pixels.frame_index < 0 || pixels.frame_index >= next_index_) {
    throw ProtocolError("pixels came for a frame that was not ordered");
  }
  if (shown_) shown_->paste(from, pixels);
  if (!pixels.is_last) return;
  ++overdue_pixels_;
  if (clock_->now_s() < clock_->deadline_s(pixels.frame_index + 1, 0))
    reserve_.learn(after_sampling_s(pixels.report));
}

// Of a frame without late ranks this is what the frame needed; one with late ranks needed more, which
// handle_overdue() learns.
double Master::after_sampling_s(const RankReport& report) const {
  return reserve_.after_sampling_s(clock_->now_s(), report.sampling_ended_s, report.cpu_ms.reconstruction);
}

// --- Lost ranks

bool Master::is_lost(int rank) const {
  return std::binary_search(lost_.begin(), lost_.end(), rank);
}

bool Master::awaits(int rank) const {
  return std::any_of(frames_.begin(), frames_.end(),
                     [rank](const auto& frame) { return frame.second.assembly.awaits(rank); });
}

// Frames that are under way are delivered at their deadlines with what has come.
void Master::give_up(const std::vector<int>& ranks) {
  if (delivered_ == 0) throw std::runtime_error("the first frame needs all ranks");
  lost_.insert(lost_.end(), ranks.begin(), ranks.end());
  std::sort(lost_.begin(), lost_.end());
  for (const int rank : ranks) network_.give_up(rank);
  balancer_.take_over(lost_);
  before_.reset();
}

// --- Delivery

void Master::keep_deadlines() {
  if (!clock_->keeps_deadlines()) return;
  const double now_s = clock_->now_s();
  for (auto& [index, frame] : frames_) {
    if (!frame.overdue_since_s && now_s >= frame.assembly.order().deadline_s) frame.overdue_since_s = now_s;
  }
  while (!frames_.empty() && is_due(frames_.begin()->second)) deliver_first();
}

bool Master::is_due(const PendingFrame& frame) const {
  if (frame.assembly.is_whole()) return true;
  if (!frame.overdue_since_s || delivered_ == 0) return false;
  return clock_->now_s() >= *frame.overdue_since_s + kGraceSeconds;
}

void Master::deliver_first() {
  const auto first = frames_.begin();
  learn_from(first->second);
  ++delivered_;
  sink_(finish(first->second));
  frames_.erase(first);
  order_if_due();
}

void Master::learn_from(const PendingFrame& frame) {
  const FrameOrder& order = frame.assembly.order();
  FrameReports reports{.is_whole = frame.assembly.is_whole(),
                       .generation = order.generation,
                       .accumulates = order.carry == Carry::kAccumulate,
                       .tiles = frame.assembly.tiles,
                       .speeds = {}};
  evidence_ = halved(evidence_);
  for (const RankReport& r : frame.assembly.reports()) {
    reports.samples += r.samples_in_region;
    const bool gone = is_lost(static_cast<int>(reports.speeds.size()));
    reports.speeds.push_back(gone ? 0 : 1 / r.pace);
    if (order.index >= evidence_since_) evidence_ += r.evidence;
  }
  balancer_.consider(std::move(reports));
  if (clock_->has_deadlines()) reserve_.learn(frame.after_sampling_s);
}

FinishedFrame Master::finish(PendingFrame& pending) {
  FrameAssembly& assembly = pending.assembly;
  FinishedFrame frame;
  if (clock_->keeps_deadlines()) {
    if (!assembly.is_whole()) frame.stale_tiles = assembly.picture.fill_gaps(shown_.value());
    shown_ = assembly.picture;
  }
  frame.order = assembly.order();
  frame.ranks.assign(assembly.reports().begin(), assembly.reports().end());
  frame.owners = assembly.picture.shown_ranks();
  frame.image = assembly.picture.take_image();
  frame.samples = std::move(assembly.samples);
  frame.tiles = std::move(assembly.tiles);
  frame.transfers = in_order(std::move(assembly.transfers));
  frame.late_ranks = assembly.late_ranks();
  frame.overdue_pixels = std::exchange(overdue_pixels_, 0);
  frame.global_balance = !frame.order.owners.empty();
  frame.error = errors_.add(frame.order.cut, frame.ranks, frame.image.pixels.size());
  if (frame.error) effort_.learn(frame.order, *frame.error);
  const DeliveryTime time = clock_->delivery_time(frame.order, frame.ranks);
  frame.finished_s = time.finished_s;
  frame.late_ms = time.late_ms;
  return frame;
}

}  // namespace pprt
