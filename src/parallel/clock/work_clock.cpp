#include "parallel/clock/work_clock.h"

#include <algorithm>

namespace pprt {

void WorkClock::begin_frame(const FrameOrder& order) {
  round_ = 0;
  budget_ = static_cast<WorkUnits>(order.periods * static_cast<double>(usual_budget_));
  effort_ = order.effort;
}

void WorkClock::begin_packet(std::uint64_t) {
  ++round_;
  // Besides reconstruction, a round's worth is kept for what the last exchange brings.
  const WorkUnits kept = reconstruction_ + budget_ / kRoundsPerFrame;
  const WorkUnits most = budget_ > kept ? budget_ - kept : 0;
  const WorkUnits sampling = effort_ < 1 ? static_cast<WorkUnits>(effort_ * static_cast<double>(most)) : most;
  round_end_ = budget_ > 0 ? sampling * static_cast<WorkUnits>(round_) / kRoundsPerFrame
                           : static_cast<WorkUnits>(round_) * kUnitsPerFreeRound;
}

double WorkClock::sampling_share() const {
  return budget_ > 0 ? static_cast<double>(std::max(round_, 1)) / kRoundsPerFrame : kShareWithoutEnd;
}

std::size_t WorkClock::affordable(Work work, double share) const {
  return static_cast<std::size_t>(share * static_cast<double>(budget_) /
                                  (slowness_ * static_cast<double>(price(work))));
}

}  // namespace pprt
