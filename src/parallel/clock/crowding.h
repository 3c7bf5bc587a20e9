// How long a rank's work takes beside others that want its core.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "parallel/clock/host_time.h"

namespace pprt {

// Learns from one thread's times, frame by frame. The last frames count most.
class Crowding {
 public:
  // A frame begins at these times. They say nothing of what was before the first: a program that starts
  // crowds itself.
  void begin_frame(const RunTimes& now) {
    constexpr double kShareKept = 0.8;
    constexpr std::int64_t kMostWaited = 7;  // of what it ran: a stall says nothing of the next frames
    const RunTimes before = last_.value_or(now);
    last_ = now;
    const std::int64_t ran_ns = now.ran_ns - before.ran_ns;
    const std::int64_t waited_ns = std::min(now.waited_ns - before.waited_ns, kMostWaited * ran_ns);
    ran_ns_ = kShareKept * ran_ns_ + static_cast<double>(ran_ns);
    waited_ns_ = kShareKept * waited_ns_ + static_cast<double>(waited_ns);
  }

  // Seconds that pass for a second of CPU time, at least 1.
  double factor() const { return ran_ns_ > 0 ? 1 + waited_ns_ / ran_ns_ : 1; }

 private:
  std::optional<RunTimes> last_;
  double ran_ns_ = 0, waited_ns_ = 0;  // of the frames so far, by their weights
};

}  // namespace pprt
