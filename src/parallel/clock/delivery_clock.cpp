#include "parallel/clock/delivery_clock.h"

#include <algorithm>
#include <cmath>

namespace pprt {

// Only deadlines make the ranks wait for a common start.
void WallDeliveryClock::begin_sequence(double start_s) {
  start_s_ = has_deadlines() ? start_s : std::min(start_s, now_());
}

// A rank that prepares a frame cannot deliver one. Where ranks share cores nobody begins before that deadline
// anyway.
bool WallDeliveryClock::may_overlap(int index) const {
  if (!keeps_deadlines()) return true;
  return ranks_per_core_ <= 1 && now_s() < deadline_s(index - 1, 0);
}

// A frame left out takes no real time.
double WallDeliveryClock::deadline_s(int index, int) const {
  return frames_per_second_ > 0 ? (index + 1) / frames_per_second_ : 0;
}

// A work unit is a nanosecond of a core.
double WallDeliveryClock::units_per_frame() const {
  return frames_per_second_ > 0 ? 1e9 / frames_per_second_ / ranks_per_core_ : 0;
}

DeliveryTime WallDeliveryClock::delivery_time(const FrameOrder& order, std::span<const RankReport>) const {
  const double finished_s = now_s();
  return {.finished_s = finished_s,
          .late_ms = frames_per_second_ > 0 ? 1e3 * (finished_s - order.deadline_s) : 0};
}

double WorkDeliveryClock::deadline_s(int index, int frames_left_out) const {
  return frames_per_second_ > 0 ? (index + frames_left_out + 1) / frames_per_second_ : 0;
}

DeliveryTime WorkDeliveryClock::delivery_time(const FrameOrder& order,
                                              std::span<const RankReport> ranks) const {
  double slowest_s = 0;
  for (const RankReport& r : ranks) slowest_s = std::max(slowest_s, r.finished_s);
  if (frames_per_second_ <= 0) return {.finished_s = slowest_s, .late_ms = 0};
  const double period_s = 1 / frames_per_second_, budget_s = budget_ / kWorkUnitsPerSecond;
  return {.finished_s = order.deadline_s - order.periods * period_s + slowest_s,
          .late_ms = 1e3 * (slowest_s - order.periods * budget_s)};
}

}  // namespace pprt
