#include "parallel/clock/frame_clock.h"

#include <sched.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>

namespace pprt {
namespace {

constexpr double kShareWithoutEnd = 0.5;

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The largest of the last few values: what a careful prediction assumes.
class RecentMaximum {
 public:
  void add(double value) { values_[next_++ % values_.size()] = value; }
  double get() const { return *std::max_element(values_.begin(), values_.end()); }

 private:
  std::array<double, 8> values_{};
  std::size_t next_ = 0;
};

class WallClock final : public FrameClock {
 public:
  // `ranks_per_core`: how many ranks share one of this host's cores, at least 1.
  WallClock(double start_s, double period_s, double ranks_per_core)
      : start_s_(start_s), period_s_(period_s), ranks_per_core_(ranks_per_core) {}

  bool may_begin(const FrameOrder& order) const override {
    return ranks_per_core_ <= 1 || monotonic_seconds() >= start_s_ + order.deadline_s - period_s_;
  }
  void begin_frame(const FrameOrder& order) override {
    frame_began_s_ = monotonic_seconds();
    frame_began_cpu_s_ = thread_cpu_seconds();
    sampling_began_s_ = rested_s_ = 0;
    deadline_s_ = order.deadline_s > 0 ? start_s_ + order.deadline_s : 0;
    reserve_s_ = order.reserve_s;
    is_at_rest_ = order.carry == Carry::kAccumulate;
    set_stop();
  }
  void spend(Work, std::uint64_t) override {}
  void rested(double seconds) override { rested_s_ += seconds; }
  void begin_packet(std::uint64_t samples) override {
    left_in_packet_ = ranks_per_core_ > 1 ? kSamplesOfAShortTurn : kSamplesPerPacket;
    size_ = static_cast<double>(samples) + region_size_;
    set_stop();
    const double now = monotonic_seconds();
    if (sampling_began_s_ == 0) sampling_began_s_ = now;
    if (stop_s_ > 0 && now >= stop_s_) goes_on_after(now);
    // With more ranks than cores, short turns keep every rank near its deadline.
    if (ranks_per_core_ > 1) sched_yield();
  }
  bool packet_over() override {
    if (left_in_packet_-- == 0) return true;
    return (left_in_packet_ & 7) == 0 && sampling_over();
  }
  bool sampling_over() override {
    if (stop_s_ == 0) return false;
    const double now = monotonic_seconds();
    return now >= stop_s_ && !goes_on_after(now);
  }
  void end_frame(double reconstruction_ms) override {
    reconstruction_s_per_size_.add(1e-3 * reconstruction_ms / size_);
  }
  std::size_t affordable(Work work, double share) const override {
    const double seconds = 1e-9 * static_cast<double>(price(work)) * ranks_per_core_;
    return static_cast<std::size_t>(share * period_s_ / seconds);
  }
  double sampling_share() const override {
    if (stop_s_ == 0) return kShareWithoutEnd;
    const double span = stop_s_ - sampling_began_s_;
    return span > 0 ? std::clamp((monotonic_seconds() - sampling_began_s_) / span, 0.01, 1.0) : 1;
  }
  void region_changed(std::size_t pixels) override {
    region_size_ = static_cast<double>(pixels) / kPixelsPerSample;
  }
  int rounds_under_way(double) const override { return 0; }
  bool in_lockstep() const override { return false; }
  double lap_ms() override {
    const double now = thread_cpu_seconds(), lap = now - last_lap_s_;
    last_lap_s_ = now;
    return 1e3 * lap;
  }
  double frame_seconds() const override { return monotonic_seconds() - frame_began_s_; }
  double sampling_end_seconds() const override { return std::max(stop_s_, sampling_began_s_) - start_s_; }
  double sequence_seconds() const override { return monotonic_seconds() - start_s_; }

 private:
  static constexpr int kSamplesPerPacket = 128, kSamplesOfAShortTurn = 48;
  static constexpr double kPixelsPerSample = 8;  // that take as long to reconstruct where edges are shown
  // Of the period, for all that follows sampling.
  static constexpr double kLeastLeft = 0.04, kMostLeftOfANewPicture = 0.7;

  void set_stop() { stop_s_ = deadline_s_ > 0 ? deadline_s_ - left_for_the_rest() : 0; }

  // A new picture that began late, or whose rank was not let run, goes on into half of the reserve, until the
  // rank has had nearly the time that others have. The next frames each have a little less until the reserve
  // is whole again: a moment lost is shared among them. Where ranks share cores no time is their own.
  bool goes_on_after(double now) {
    constexpr double kShareOfOthers = 0.93;
    if (ranks_per_core_ > 1 || is_at_rest_ || reconstruction_s() == 0) return false;
    const double had_s = thread_cpu_seconds() - frame_began_cpu_s_ + rested_s_;
    const double lacks_s = kShareOfOthers * (period_s_ - reconstruction_s()) - had_s;
    const double until_s = std::min(now + lacks_s, latest_s());
    if (until_s <= now) return false;
    stop_s_ = until_s;
    return true;
  }
  double latest_s() const {
    constexpr double kLeastOfReserve = 0.5;
    return deadline_s_ - std::max(kLeastOfReserve * reserve_s_ + reconstruction_s(), kLeastLeft * period_s_);
  }

  // After sampling: this rank's own reconstruction beside those of the ranks that share its core, and what
  // else the master has seen to pass until a frame is whole. A resting picture whose reconstruction fills the
  // frame is fine enough; a new one gets some samples, whatever that takes.
  double left_for_the_rest() const {
    const double most = is_at_rest_ ? 1 : kMostLeftOfANewPicture;
    return std::clamp(reserve_s_ + reconstruction_s(), kLeastLeft * period_s_, most * period_s_);
  }

  // As the slowest of the last frames had it, and a quarter more for luck.
  double reconstruction_s() const {
    return 1.25 * reconstruction_s_per_size_.get() * size_ * ranks_per_core_;
  }

  double start_s_;
  double period_s_;
  double ranks_per_core_;
  double frame_began_s_ = 0;
  double deadline_s_ = 0;  // 0: no rate
  double reserve_s_ = 0;   // for what follows reconstruction
  bool is_at_rest_ = false;
  double stop_s_ = 0;            // when sampling must stop; 0: no rate
  double sampling_began_s_ = 0;  // of this frame; 0: not yet
  double frame_began_cpu_s_ = 0;
  double rested_s_ = 0;     // in this frame
  double size_ = 1;         // of what is to be reconstructed, in samples
  double region_size_ = 0;  // what the region's pixels add to it
  RecentMaximum reconstruction_s_per_size_;
  int left_in_packet_ = 0;
  double last_lap_s_ = thread_cpu_seconds();
};

class WorkClock final : public FrameClock {
 public:
  WorkClock(const SessionSettings& settings, std::size_t region_pixels)
      : units_per_second_(settings.machine.units_per_second),
        budget_(settings.frames_per_second > 0 ? settings.budget_units : 0),
        reconstruction_(price(Work::kPixel) * region_pixels) {}

  bool may_begin(const FrameOrder&) const override { return true; }
  void begin_frame(const FrameOrder&) override {
    frame_units_ = 0;
    round_ = 0;
  }
  void spend(Work work, std::uint64_t count) override { frame_units_ += price(work) * count; }
  void rested(double) override {}
  void begin_packet(std::uint64_t) override {
    ++round_;
    // Besides reconstruction, a round's worth is kept for what the last exchange brings.
    const WorkUnits kept = reconstruction_ + budget_ / kRoundsPerFrame;
    const WorkUnits sampling = budget_ > kept ? budget_ - kept : 0;
    round_end_ = budget_ > 0 ? sampling * static_cast<WorkUnits>(round_) / kRoundsPerFrame
                             : static_cast<WorkUnits>(round_) * kUnitsPerFreeRound;
  }
  bool packet_over() override { return frame_units_ >= round_end_; }
  bool sampling_over() override { return budget_ > 0 && round_ >= kRoundsPerFrame; }
  void end_frame(double) override {
    sequence_units_ += frame_units_;
    lap_began_ -= static_cast<double>(frame_units_);
  }
  std::size_t affordable(Work work, double share) const override {
    return static_cast<std::size_t>(share * static_cast<double>(budget_) / static_cast<double>(price(work)));
  }
  double sampling_share() const override {
    return budget_ > 0 ? static_cast<double>(std::max(round_, 1)) / kRoundsPerFrame : kShareWithoutEnd;
  }
  void region_changed(std::size_t pixels) override { reconstruction_ = price(Work::kPixel) * pixels; }
  int rounds_under_way(double seconds) const override {
    const double round_units = budget_ > 0 ? static_cast<double>(budget_) / kRoundsPerFrame
                                           : static_cast<double>(kUnitsPerFreeRound);
    return static_cast<int>(std::min(seconds * units_per_second_ / round_units, 1e6));
  }
  bool in_lockstep() const override { return true; }
  double lap_ms() override {
    const double lap = static_cast<double>(frame_units_) - lap_began_;
    lap_began_ = static_cast<double>(frame_units_);
    return 1e-6 * lap;
  }
  double frame_seconds() const override { return static_cast<double>(frame_units_) / kWorkUnitsPerSecond; }
  double sampling_end_seconds() const override { return sequence_seconds(); }
  double sequence_seconds() const override {
    return static_cast<double>(sequence_units_ + frame_units_) / kWorkUnitsPerSecond;
  }

 private:
  double units_per_second_;   // of the machine that is pretended
  WorkUnits budget_;          // a frame's; 0: no rate
  WorkUnits reconstruction_;  // what it will cost
  WorkUnits frame_units_ = 0;
  WorkUnits sequence_units_ = 0;
  WorkUnits round_end_ = 0;
  int round_ = 0;
  double lap_began_ = 0;
};

}  // namespace

std::unique_ptr<FrameClock> make_frame_clock(const SessionSettings& settings, double start_s,
                                             std::size_t region_pixels, double ranks_per_core) {
  if (settings.clock == ClockKind::kWork) return std::make_unique<WorkClock>(settings, region_pixels);
  const double fps = settings.frames_per_second;
  return std::make_unique<WallClock>(start_s, fps > 0 ? 1 / fps : 0, ranks_per_core);
}

double monotonic_seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace pprt
