// A clock that shows what the test sets, for one rank in its own thread.
#pragma once

#include "parallel/clock/frame_clock.h"

namespace pprt {

// A frame has six packets of so many samples; nothing is ever unaffordable.
class SetClock final : public FrameClock {
 public:
  SetClock(int samples_per_packet, double period_s, const double& now_s)
      : samples_per_packet_(samples_per_packet), period_s_(period_s), now_s_(now_s) {}

  bool may_begin(const FrameOrder&) const override { return true; }
  void begin_frame(const FrameOrder&) override { packets_ = 0; }
  void spend(Work, std::uint64_t) override {}
  void rested(double) override {}
  void begin_packet(std::uint64_t) override { left_ = samples_per_packet_, ++packets_; }
  bool packet_over() override { return left_-- == 0; }
  bool sampling_over() override { return packets_ >= 6; }
  void end_frame(double) override {}
  std::size_t affordable(Work, double) const override { return 100'000; }
  bool in_lockstep() const override { return false; }
  double lap_ms() override { return 0; }
  int rounds_under_way(double) const override { return 0; }
  double sampling_share() const override { return 0.25; }
  void region_changed(std::size_t) override {}
  double frame_seconds() const override { return period_s_; }
  double sampling_end_seconds() const override { return now_s_; }
  double sequence_seconds() const override { return now_s_; }

 private:
  int samples_per_packet_;
  double period_s_;
  const double& now_s_;
  int packets_ = 0;
  int left_ = 0;
};

}  // namespace pprt
