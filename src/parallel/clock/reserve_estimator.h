// The time that a frame needs after sampling, learned from the frames before (paper s. 4.6).
#pragma once

#include <cstddef>
#include <deque>

namespace pprt {

// What ranks must leave between the end of sampling and the deadline, besides their own reconstruction: the
// last exchange, sending, pasting, and what the host's scheduler takes.
class ReserveEstimator {
 public:
  // `period_s`: seconds from frame to frame, 0 without a rate. `ranks_per_core`: at least 1.
  ReserveEstimator(double period_s, double ranks_per_core)
      : period_s_(period_s), ranks_per_core_(ranks_per_core) {}

  // Returns the seconds from the end of sampling until a rank's pixels arrived at `arrived_s`.
  // Reconstruction, by all ranks of a core, is taken off: it grows with their samples, and a rank leaves room
  // for it itself. Both times are seconds since the sequence began.
  double after_sampling_s(double arrived_s, double sampling_ended_s, double reconstruction_ms) const;

  // Remembers what one frame needed; the last twelve count.
  void learn(double after_sampling_s);

  // The reserve, seconds: the worst of the frames remembered and a quarter more, or seven tenths more where
  // ranks share cores, for those are not punctual. At most seven tenths of the period, so that some sampling
  // remains. 0 without a rate.
  double reserve_s() const;

 private:
  double period_s_;
  double ranks_per_core_;
  std::deque<double> after_sampling_s_;
};

}  // namespace pprt
