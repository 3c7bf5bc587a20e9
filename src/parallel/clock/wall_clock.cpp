#include "parallel/clock/wall_clock.h"

#include <sched.h>

#include <utility>

namespace pprt {
namespace {

// Samples between two exchanges; fewer where ranks share cores, so that each has its turn near its deadline.
constexpr int kSamplesPerPacket = 128, kSamplesOfAShortTurn = 48;

// Pixels that take as long to reconstruct as one sample, where edges are shown.
constexpr double kPixelsPerSample = 8;

// The same of pixels that show several surfaces: samples that take as long as one of them.
constexpr double kSamplesPerMixedPixel = 8;

// Seconds that a sample's share of reconstruction is expected to take before any was measured. On an AMD EPYC
// it is 80 to 170 ns.
constexpr double kFirstSecondsPerSize = 1.3e-7;

// Shares of the period, and of a new picture's time, that are left for all that follows sampling.
constexpr double kLeastLeft = 0.04, kMostLeftOfANewPicture = 0.7;

// Share of it that is reserved, at most, where others want the core.
constexpr double kMostForOthers = 0.4;

// Share of the time that goes into the reconstruction of a resting picture.
constexpr double kMostForRefreshing = 0.35;

}  // namespace

bool WallClock::may_begin(const FrameOrder& order) const {
  const double now = sequence_.now_s();
  const bool is_turn = ranks_per_core_ <= 1 || now >= order.deadline_s - order.periods * usual_period_s_;
  return is_turn && now >= order.not_before_s;
}

bool WallClock::is_past(const FrameOrder& order) const {
  return order.deadline_s > 0 && order.index > 0 && !order.is_awaited &&
         sequence_.now_s() >= order.deadline_s;
}

void WallClock::begin_frame(const FrameOrder& order) {
  crowding_.begin_frame(run_times_());
  frame_began_s_ = sequence_.now_s();
  sampling_began_s_ = packet_began_s_ = frame_began_s_;
  is_sampling_ = false;
  deadline_s_ = order.deadline_s;
  period_s_ = order.periods * usual_period_s_;
  effort_ = order.effort;
  is_first_ = order.index == 0;
  // The last frames may not have met those that want the core.
  reserve_s_ = std::max(order.reserve_s, kMostForOthers * period_s_ * std::min(crowding_.factor() - 1, 1.0));
  is_at_rest_ = order.carry == Carry::kAccumulate;
  take_turns();
  set_stop();
}

void WallClock::end_frame(double reconstruction_ms, double share) {
  if (size_ <= 0 || share <= 0) return;
  RecentValues& per_size = is_at_rest_       ? resting_s_per_size_
                           : mixed_size_ > 0 ? seen_s_per_size_
                                             : unseen_s_per_size_;
  per_size.add(1e-3 * reconstruction_ms / (share * size_));
}

void WallClock::region_changed(std::size_t pixels) {
  region_size_ = static_cast<double>(pixels) / kPixelsPerSample;
}

void WallClock::mixed_pixels_found(std::size_t pixels) {
  mixed_size_ = kSamplesPerMixedPixel * static_cast<double>(pixels);
  size_ = samples_size_ + region_size_ + mixed_size_;
}

// Seeing takes about as long as painting.
double WallClock::mixed_pixel_units() const {
  constexpr double kWithSeeing = 2;
  return kWithSeeing * kSamplesPerMixedPixel * 1e9 * seen_s_per_size_.least() / pace_;
}

void WallClock::begin_packet(std::uint64_t samples) {
  left_in_packet_ = ranks_per_core_ > 1 ? kSamplesOfAShortTurn : kSamplesPerPacket;
  samples_size_ = static_cast<double>(samples);
  size_ = samples_size_ + region_size_ + mixed_size_;
  set_stop();
  if (is_at_rest_ && sampling_over()) left_in_packet_ = 0;
  packet_began_s_ = sequence_.now_s();
  if (!std::exchange(is_sampling_, true))
    sampling_began_s_ = packet_began_s_, rested_before_sampling_s_ = rested_s_;
  // With more ranks than cores, short turns keep every rank near its deadline.
  if (ranks_per_core_ > 1) sched_yield();
}

bool WallClock::packet_over() {
  if (left_in_packet_ == 0) return true;
  --left_in_packet_;
  return (left_in_packet_ & 7) == 0 && sampling_over();
}

bool WallClock::sampling_over() {
  return stop_s_ != 0 && sequence_.now_s() >= stop_s_;
}

bool WallClock::reconstruction_over() {
  if (!is_at_rest_ || deadline_s_ == 0) return false;
  if (!refreshes_in_parts_) return !is_turn_;
  // Tiles take different times. What comes before the first of them is another matter.
  constexpr double kShareKept = 0.9;
  const double now = sequence_.now_s(), part_s = now - std::exchange(part_began_s_, now);
  if (!std::exchange(is_first_part_, false)) longest_part_s_ = std::max(part_s, kShareKept * longest_part_s_);
  return now + longest_part_s_ >= deadline_s_ - std::max(reserve_s_, kLeastLeft * period_s_);
}

void WallClock::end_sampling(double units) {
  // About 150 samples: fewer say nothing.
  constexpr double kLeastUnits = 2e5, kShareOfNew = 0.25;
  part_began_s_ = sequence_.now_s();
  is_first_part_ = true;
  if (units < kLeastUnits) return;
  const double took_s = part_began_s_ - sampling_began_s_ - (rested_s_ - rested_before_sampling_s_);
  const double pace = 1e9 * took_s / units;
  pace_ += (knows_pace_ ? kShareOfNew : 1) * (pace - pace_);
  knows_pace_ = true;
}

double WallClock::sampling_share() const {
  if (stop_s_ == 0) return kShareWithoutEnd;
  const double span = stop_s_ - sampling_began_s_;
  return span > 0 ? std::clamp((sequence_.now_s() - sampling_began_s_) / span, 0.01, 1.0) : 1;
}

std::optional<double> WallClock::expected_growth(std::size_t begin, std::size_t now) const {
  if (deadline_s_ == 0 || now == 0) return std::nullopt;
  const double share = sampling_share();
  return 1 + (1 - static_cast<double>(begin) / static_cast<double>(now)) * (1 - share) / share;
}

// Before anything is seen a pixel of several surfaces takes no longer than others. The reserve is for the
// worst of the last frames; of a usual one half of it is left, and a mixed pixel takes what it took in the
// quickest. Others that want the core make frames as bad as the worst: at half a core's time for them,
// always.
std::optional<TimeForecast> WallClock::forecast(std::size_t samples, double seconds_of_each) const {
  if (deadline_s_ == 0 || samples == 0 || seconds_of_each <= 0) return std::nullopt;
  constexpr double kUsualOfReserve = 0.5, kAlwaysBad = 0.5;
  const double now = static_cast<double>(samples);
  const double bad = is_first_ ? 1 : std::min((crowding_.factor() - 1) / kAlwaysBad, 1.0);
  const double usual_s = (1 - bad) * (1 - kUsualOfReserve) * reserve_s_;
  const double left_s = latest_s(now + region_size_, false) + usual_s - sequence_.now_s();
  const double each_s = seconds_of_each * seconds_of_cpu_second();
  const double quickest_s = seen_s_per_size_.least();
  const double seen_s = quickest_s + bad * (seen_s_per_size_.greatest() - quickest_s);
  return TimeForecast{now + std::max(left_s, 0.0) / (each_s + reconstruction_s(1, false)),
                      kSamplesPerMixedPixel * (seen_s > 0 ? seen_s : kFirstSecondsPerSize) / seconds_of_each,
                      seconds_of_each, [this] { return 1e-9 * static_cast<double>(used_ns()); }};
}

std::size_t WallClock::affordable(Work work, double share) const {
  const double seconds = 1e-9 * static_cast<double>(price(work)) * ranks_per_core_;
  return static_cast<std::size_t>(share * period_s_ / seconds);
}

double WallClock::rested(double seconds) {
  rested_s_ += seconds;
  return 1e3 * seconds;
}

bool WallClock::is_fine_enough() const {
  return deadline_s_ > 0 && is_at_rest_ && !refreshes_in_parts_ &&
         reserve_s_ + reconstruction_s(size_, mixed_size_ > 0) >= period_s_;
}

// Seconds after sampling: for this rank's own reconstruction beside those of the ranks that share its core,
// and for what else the master has seen to pass until a frame is whole. A new picture gets some samples,
// whatever that takes. A resting one is reconstructed in parts or by turns.
double WallClock::left_for_the_rest(double size, bool is_seen) const {
  double reconstruction_s = is_turn_ ? this->reconstruction_s(size, is_seen) : 0;
  if (is_at_rest_ && refreshes_in_parts_)
    reconstruction_s =
        std::max(unshown_ * reconstruction_s, std::min(reconstruction_s, kMostForRefreshing * period_s_));
  // A rank that was done early with the frame before has more than the period.
  const double span_s = std::clamp(deadline_s_ - frame_began_s_, period_s_, 2 * period_s_);
  const double most_s = is_at_rest_ ? period_s_ : kMostLeftOfANewPicture * span_s;
  return std::clamp(reserve_s_ + reconstruction_s, kLeastLeft * period_s_, most_s);
}

// A resting picture without parts is reconstructed when the frames since have saved the time for it.
void WallClock::take_turns() {
  is_turn_ = true;
  if (!is_at_rest_ || refreshes_in_parts_) return;
  saved_s_ += kMostForRefreshing * period_s_;
  is_turn_ = saved_s_ >= reconstruction_s(size_, mixed_size_ > 0);
  if (is_turn_) saved_s_ = 0;
}

void WallClock::set_stop() {
  stop_s_ = deadline_s_ > 0 ? latest_s(size_, mixed_size_ > 0) : 0;
}

// When sampling must stop, of a frame with a deadline and so much to reconstruct.
double WallClock::latest_s(double size, bool is_seen) const {
  const double latest_s = deadline_s_ - left_for_the_rest(size, is_seen);
  return effort_ < 1 ? frame_began_s_ + effort_ * std::max(0.0, latest_s - frame_began_s_) : latest_s;
}

// Predicted seconds: as in the slowest of the last frames of its kind, and a quarter more. A resting picture
// of many samples takes less for each of them, which says little of the first after it.
double WallClock::reconstruction_s(double size, bool is_seen) const {
  const double of_new = (is_seen ? seen_s_per_size_ : unseen_s_per_size_).greatest();
  const double of_resting = resting_s_per_size_.greatest();
  const bool is_as_resting = of_resting > 0 && (is_at_rest_ || of_new <= 0);
  const double slowest = is_as_resting ? of_resting : of_new;
  return 1.25 * (slowest > 0 ? slowest : kFirstSecondsPerSize) * size * ranks_per_core_;
}

// The ranks that share a core are among those that crowd it. But they rest by turns, and who rests crowds
// nobody. Reconstruction is not stretched by it: the master's reserve grows where that takes longer.
double WallClock::seconds_of_cpu_second() const {
  return std::max(ranks_per_core_, crowding_.factor());
}

}  // namespace pprt
