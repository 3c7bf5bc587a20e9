// Charges a rank's CPU time to the stages of a frame (paper Fig. 9a).
#pragma once

#include <cstdint>

#include "parallel/clock/frame_clock.h"

namespace pprt {

// Invariant: from start() to the last end_stage() every nanosecond of the clock is charged to exactly one
// stage, so that the stages' sum is the frame's time.
class StageTimer {
 public:
  explicit StageTimer(FrameClock& clock) : clock_(clock) {}

  // All times are 0 from now on. Waiting counts at once, CPU time from start() on.
  void begin_frame() { times_ = {}; }
  void start() {
    began_ns_ = clock_.used_ns();
    interrupted_ns_ = 0;
  }

  // Charges to `stage` what has passed since start() or the last call, balancing excluded. Returns that,
  // milliseconds.
  double end_stage(double StageTimes::*stage) {
    const std::int64_t now_ns = clock_.used_ns();
    const double ms = 1e-6 * static_cast<double>(now_ns - began_ns_ - interrupted_ns_);
    times_.*stage += ms;
    began_ns_ = now_ns;
    interrupted_ns_ = 0;
    return ms;
  }

  // Its lifetime is charged to balancing, and to no other stage. Scopes do not nest, and hold no end_stage().
  class Balancing {
   public:
    explicit Balancing(StageTimer& timer) : timer_(timer), began_ns_(timer.clock_.used_ns()) {}
    ~Balancing() {
      const std::int64_t ns = timer_.clock_.used_ns() - began_ns_;
      timer_.times_.balancing += 1e-6 * static_cast<double>(ns);
      timer_.interrupted_ns_ += ns;
    }
    Balancing(const Balancing&) = delete;
    Balancing& operator=(const Balancing&) = delete;

   private:
    StageTimer& timer_;
    std::int64_t began_ns_;
  };

  // Counts seconds of waiting as idle, by the clock's rule.
  void rested(double seconds) { times_.idle += clock_.rested(seconds); }

  const StageTimes& times() const { return times_; }

 private:
  FrameClock& clock_;
  StageTimes times_;
  std::int64_t began_ns_ = 0;
  std::int64_t interrupted_ns_ = 0;  // of the stage that runs: charged to balancing already
};

}  // namespace pprt
