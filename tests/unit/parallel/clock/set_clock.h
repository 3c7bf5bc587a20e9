// A clock that shows what the test sets, for one rank in its own thread.
#pragma once

#include <vector>

#include "parallel/clock/frame_clock.h"

namespace pprt {

// A frame has six packets of so many samples; nothing is ever unaffordable. Every reading of the CPU time is
// a millisecond after the one before.
class SetClock final : public FrameClock {
 public:
  SetClock(int samples_per_packet, double period_s, const double& now_s)
      : samples_per_packet_(samples_per_packet), period_s_(period_s), now_s_(now_s) {}

  bool learns_from_rehearsal() const override { return true; }
  bool may_begin(const FrameOrder&) const override { return true; }
  bool is_past(const FrameOrder& order) const override {
    return order.index > 0 && now_s_ >= order.deadline_s;
  }
  void begin_frame(const FrameOrder&) override { packets_ = 0; }
  void end_frame(double reconstruction_ms, double) override { learned_ms_.push_back(reconstruction_ms); }
  void region_changed(std::size_t) override {}
  void mixed_pixels_found(std::size_t) override {}
  double mixed_pixel_units() const override { return 0; }
  void unshown_found(double) override {}

  void begin_packet(std::uint64_t) override { left_ = samples_per_packet_, ++packets_; }
  bool packet_over() override {
    if (left_ == 0) return true;
    --left_;
    return false;
  }
  bool sampling_over() override { return packets_ >= kPackets; }
  bool is_fine_enough() const override { return false; }
  bool reconstruction_over() override { return !may_refresh_; }
  void end_sampling(double) override {}
  double pace() const override { return 1; }
  double sampling_share() const override { return packets_ < kPackets ? 0.25 : 1; }
  std::optional<TimeForecast> forecast(std::size_t samples, double seconds_of_each) const override {
    asked_before_packets_ += samples > 0 && seconds_of_each > 0 && packets_ == 0;
    return forecast_;
  }
  std::optional<double> expected_growth(std::size_t, std::size_t) const override { return std::nullopt; }

  void spend(Work, std::uint64_t) override {}
  std::size_t affordable(Work, double) const override { return 100'000; }
  double rested(double) override { return 0; }

  std::int64_t used_ns() const override { return std::int64_t{1'000'000} * ++readings_; }
  double as_evidence_ms(double measured_ms) const override { return measured_ms; }
  double frame_seconds() const override { return period_s_; }
  double sampling_end_seconds() const override { return now_s_; }

  int readings() const { return readings_; }

  // How often it was asked before a frame's first packet what the time is good for.
  int asked_before_packets() const { return asked_before_packets_; }

  // What the time of each frame is good for, from now on.
  void set_forecast(const TimeForecast& forecast) { forecast_ = forecast; }

  // What the reconstruction of each frame took, as it was told.
  const std::vector<double>& learned_ms() const { return learned_ms_; }

  // From now on no time is left for the reconstruction of a resting picture.
  void forbid_refresh() { may_refresh_ = false; }

 private:
  static constexpr int kPackets = 6;

  int samples_per_packet_;
  double period_s_;
  const double& now_s_;
  mutable int readings_ = 0, asked_before_packets_ = 0;
  std::vector<double> learned_ms_;
  std::optional<TimeForecast> forecast_;
  int packets_ = 0;
  int left_ = 0;
  bool may_refresh_ = true;
};

}  // namespace pprt
