#include "parallel/master.h"

#include <algorithm>
#include <string>
#include <utility>

#include "parallel/frame_clock.h"
#include "parallel/global_balance.h"
#include "parallel/work_units.h"

namespace pprt {
namespace {

// The share of a period that follows sampling, before any frame has shown it.
constexpr double kFirstGuess = 0.2;

// How many frames may be ordered and not yet whole.
constexpr std::size_t kMostIncompleteFrames = 4;

}  // namespace

Master::Master(Communicator& network, const SessionSettings& settings, const Partition& partition,
               double ranks_per_core, CameraSource source, FrameSink sink)
    : network_(network),
      settings_(settings),
      partition_(partition),
      ranks_per_core_(ranks_per_core),
      source_(std::move(source)),
      sink_(std::move(sink)) {
  if (settings.frames_per_second > 0) after_sampling_s_.push_back(kFirstGuess / settings.frames_per_second);
}

void Master::begin_sequence(double start_s) {
  start_s_ = start_s;
  order_next();
}

void Master::frame_begun() {
  order_is_due_ = true;
  order_if_due();
}

// A rank that falls behind holds back the orders, not the memory: its frames would pile up.
void Master::order_if_due() {
  if (!order_is_due_ || assemblies_.size() >= kMostIncompleteFrames) return;
  order_is_due_ = false;
  order_next();
}

void Master::handle(const Message& message) {
  const PixelMessage pixels = decode_pixels(message.payload);
  const auto found = assemblies_.find(pixels.frame_index);
  if (found == assemblies_.end()) throw ProtocolError("pixels came for a frame that was not ordered");
  Assembly& assembly = found->second;
  paste(assembly, message.from, pixels);
  if (--assembly.missing > 0) return;
  // Every rank sends its frames in order, so no earlier frame can still be incomplete.
  deliver(assembly);
  assemblies_.erase(found);
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
    if (settings_.frames_per_second > 0) order.deadline_s = (order.index + 1) / settings_.frames_per_second;
    order.reserve_s = reserve_s();
    const bool hands_over = order.carry != Carry::kNothing && settings_.keep_samples;
    if (hands_over && !can_afford_to_hand_over()) next_owners_.clear();
    if (!next_owners_.empty()) ++generation_;
    order.owners = std::exchange(next_owners_, {});
    order.generation = generation_;
    const auto ranks = static_cast<std::size_t>(network_.size());
    assemblies_[order.index] = {order,
                                Image(settings_.width, settings_.height),
                                std::vector<RankReport>(ranks),
                                std::vector<std::vector<TileReport>>(ranks),
                                std::vector<std::uint8_t>(partition_.owner.size(), 0),
                                std::vector<std::int32_t>(partition_.owner.size(), -1),
                                {},
                                network_.size()};
    before_ = request;
  } else {
    order.end = ended_ = true;
  }
  for (int rank = 0; rank < network_.size(); ++rank) network_.send(rank, Tag::kFrameOrder, encode(order));
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
    default:
      return Carry::kNothing;
  }
}

void Master::paste(Assembly& assembly, int from, const PixelMessage& message) const {
  const auto rank = static_cast<std::size_t>(from);
  assembly.ranks[rank] = message.report;
  assembly.tiles[rank] = message.tiles;
  assembly.samples.insert(assembly.samples.end(), message.samples.begin(), message.samples.end());
  std::size_t next = 0;
  const auto paste_tile = [&](std::int32_t tile, bool by_owner) {
    if (tile < 0 || tile >= partition_.grid.tile_count())
      throw ProtocolError("pixels of a tile that is none");
    const PixelRect rect = partition_.grid.pixels(tile);
    if (message.rgb.size() - next < 3 * rect.area()) throw ProtocolError("pixels are missing in a message");
    std::uint8_t& shown = assembly.shown_by_owner[static_cast<std::size_t>(tile)];
    const bool stands = shown != 0 && !by_owner;  // what a former owner sends only fills a gap
    shown = shown != 0 || by_owner;
    if (!stands) assembly.owners[static_cast<std::size_t>(tile)] = from;
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x, next += 3) {
        if (stands) continue;
        assembly.image.at(x, y) = Color(message.rgb[next], message.rgb[next + 1], message.rgb[next + 2]);
      }
    }
  };
  for (const TileReport& tile : message.tiles) paste_tile(tile.tile, true);
  for (const std::int32_t tile : message.given) paste_tile(tile, false);
}

// From what the frame's tiles took, the partition for the next order; in combined only where it is worth it.
void Master::balance_globally(const Assembly& assembly) {
  const bool always = settings_.balance == BalanceMode::kGlobal;
  if (!always && settings_.balance != BalanceMode::kCombined) return;
  if (network_.size() == 1 || (!always && imbalance(assembly.tiles) <= kImbalanceTrigger)) return;
  next_owners_ =
      bisect(partition_.grid, predicted_costs(partition_.grid, assembly.tiles), network_.size()).owner;
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
  ++delivered_;
  samples_delivered_ = 0;
  for (const RankReport& r : assembly.ranks) samples_delivered_ += r.samples_in_region;
  balance_globally(assembly);
  FinishedFrame frame;
  frame.global_balance = !assembly.order.owners.empty();
  const double period = settings_.frames_per_second > 0 ? 1 / settings_.frames_per_second : 0;
  if (settings_.clock == ClockKind::kWork) {
    double slowest = 0;
    for (const RankReport& r : assembly.ranks) slowest = std::max(slowest, r.finished_s);
    const double budget_s = static_cast<double>(settings_.budget_units) / kWorkUnitsPerSecond;
    frame.finished_s = assembly.order.index * period + slowest;
    frame.late_ms = period > 0 ? 1e3 * (slowest - budget_s) : 0;
  } else {
    frame.finished_s = monotonic_seconds() - start_s_;
    frame.late_ms = period > 0 ? 1e3 * (frame.finished_s - assembly.order.deadline_s) : 0;
    learn_reserve(assembly, frame.finished_s);
  }
  frame.order = assembly.order;
  frame.image = std::move(assembly.image);
  frame.ranks = std::move(assembly.ranks);
  frame.owners = std::move(assembly.owners);
  frame.samples = std::move(assembly.samples);
  sink_(std::move(frame));
}

void Master::learn_reserve(const Assembly& assembly, double finished_s) {
  constexpr std::size_t kRemembered = 12;
  double first_end = finished_s;
  for (const RankReport& r : assembly.ranks) first_end = std::min(first_end, r.sampling_ended_s);
  after_sampling_s_.push_back(finished_s - first_end);
  if (after_sampling_s_.size() > kRemembered) after_sampling_s_.pop_front();
}

// What to leave between the end of sampling and the deadline: the worst of the last frames (and, for the
// first ones, of a careful guess) and seven tenths more, for ranks that share cores are not punctual; and
// what four frames of growth will add: an order goes out before the two frames ahead of it are whole, and
// where samples accumulate every reconstruction takes longer. At least a twenty-fifth of the period; at most
// seven tenths, so that some sampling remains.
double Master::reserve_s() const {
  if (settings_.frames_per_second <= 0) return 0;
  const double period = 1 / settings_.frames_per_second;
  const double worst = *std::max_element(after_sampling_s_.begin(), after_sampling_s_.end());
  const double span = static_cast<double>(after_sampling_s_.size());
  const double growth = std::max(0.0, (after_sampling_s_.back() - after_sampling_s_.front()) / span);
  return std::clamp(1.7 * worst + 4 * growth + 0.001, 0.04 * period, 0.7 * period);
}

}  // namespace pprt
