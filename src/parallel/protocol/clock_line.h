// How a rank's clock stands to rank 0's.
#pragma once

namespace pprt {

// Turns the time of a rank's clock into rank 0's: both count seconds, each from a moment of its own, and one
// may run a little faster.
struct ClockLine {
  double at = 0;      // the rank's time for which `ahead` holds
  double ahead = 0;   // how far rank 0's clock is ahead of the rank's, seconds
  double faster = 0;  // by how much rank 0's clock runs faster: 1e-6 is one second in eleven days

  double to_rank_0(double time) const { return time + ahead + faster * (time - at); }
};

}  // namespace pprt
