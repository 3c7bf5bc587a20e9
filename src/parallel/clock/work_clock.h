// Counted work: virtual time that depends on the work done alone (docs/decisions/0006-work-clock.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "parallel/clock/frame_clock.h"
#include "parallel/settings/work_units.h"

namespace pprt {

class WorkClock final : public FrameClock {
 public:
  // `budget`: work units of one frame, 0 without a rate. `region_pixels`: pixels that this rank reconstructs.
  // `slowness`: how many times its price each piece of work takes this rank.
  WorkClock(WorkUnits budget, std::size_t region_pixels, double slowness = 1)
      : usual_budget_(budget),
        budget_(budget),
        slowness_(slowness),
        reconstruction_(cost(Work::kPixel, region_pixels)) {}

  bool learns_from_rehearsal() const override { return false; }
  bool may_begin(const FrameOrder&) const override { return true; }
  bool is_past(const FrameOrder&) const override { return false; }
  void begin_frame(const FrameOrder& order) override;
  void end_frame(double, double) override { frames_before_ += std::exchange(frame_units_, 0); }
  void region_changed(std::size_t pixels) override { reconstruction_ = cost(Work::kPixel, pixels); }

  void mixed_pixels_found(std::size_t) override {}
  double mixed_pixel_units() const override { return 0; }
  void unshown_found(double) override {}

  void begin_packet(std::uint64_t samples) override;
  bool packet_over() override { return frame_units_ >= round_end_; }
  bool sampling_over() override { return budget_ > 0 && round_ >= kRoundsPerFrame; }
  bool is_fine_enough() const override { return false; }
  bool reconstruction_over() override { return false; }
  void end_sampling(double) override {}
  double pace() const override { return slowness_; }
  double sampling_share() const override;
  std::optional<double> expected_growth(std::size_t, std::size_t) const override { return std::nullopt; }
  std::optional<TimeForecast> forecast(std::size_t, double) const override { return std::nullopt; }

  void spend(Work work, std::uint64_t count) override { frame_units_ += cost(work, count); }
  std::size_t affordable(Work work, double share) const override;
  double rested(double) override { return 0; }

  std::int64_t used_ns() const override { return static_cast<std::int64_t>(frames_before_ + frame_units_); }
  double as_evidence_ms(double) const override { return 0; }
  double frame_seconds() const override { return static_cast<double>(frame_units_) / kWorkUnitsPerSecond; }
  double sampling_end_seconds() const override {
    return static_cast<double>(frames_before_ + frame_units_) / kWorkUnitsPerSecond;
  }

 private:
  WorkUnits cost(Work work, std::uint64_t count) const {
    return static_cast<WorkUnits>(slowness_ * static_cast<double>(price(work) * count));
  }

  WorkUnits usual_budget_;  // 0: no rate
  WorkUnits budget_;        // of this frame
  double effort_ = 1;       // share of the sampling time that the frame takes
  double slowness_;
  WorkUnits reconstruction_;  // what it will cost
  WorkUnits frame_units_ = 0;
  WorkUnits frames_before_ = 0;  // units of all frames before this one
  WorkUnits round_end_ = 0;
  int round_ = 0;
};

}  // namespace pprt
