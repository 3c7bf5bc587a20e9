// The time of a sequence, the same on all ranks.
#pragma once

#include <functional>
#include <utility>

#include "parallel/clock/clock_estimate.h"
#include "parallel/clock/host_time.h"

namespace pprt {

// One rank's clock, set by rank 0's: at the start and, on the wall clock, about once a second from then on.
class SequenceClock {
 public:
  // `own` tells the time as monotonic_seconds() does.
  explicit SequenceClock(std::function<double()> own = monotonic_seconds) : own_(std::move(own)) {}

  // What rank 0 knows of this rank's clock.
  void set(const ClockLine& line) { line_ = line; }

  // The sequence begins at this time of rank 0's clock.
  void begin(double start_s) { start_s_ = start_s; }

  double start_s() const { return start_s_; }

  // This rank's own time, seconds.
  double own_s() const { return own_(); }

  // Seconds since the sequence began.
  double now_s() const { return line_.to_rank_0(own_()) - start_s_; }

 private:
  std::function<double()> own_;
  ClockLine line_;
  double start_s_ = 0;
};

}  // namespace pprt
