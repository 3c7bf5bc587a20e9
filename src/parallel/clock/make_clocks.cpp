#include "parallel/clock/make_clocks.h"

#include <utility>

#include "parallel/clock/free_exchange.h"
#include "parallel/clock/lockstep_exchange.h"
#include "parallel/clock/wall_clock.h"
#include "parallel/clock/work_clock.h"

namespace pprt {
namespace {

double period_s(const SessionSettings& settings) {
  return settings.frames_per_second > 0 ? 1 / settings.frames_per_second : 0;
}

// Work units of one frame; 0 without a rate.
WorkUnits budget(const SessionSettings& settings) {
  return settings.frames_per_second > 0 ? settings.budget_units : 0;
}

double units_per_round(const SessionSettings& settings) {
  const WorkUnits of_frame = budget(settings);
  return of_frame > 0 ? static_cast<double>(of_frame) / kRoundsPerFrame
                      : static_cast<double>(kUnitsPerFreeRound);
}

}  // namespace

bool is_reproducible(const SessionSettings& settings) {
  return settings.clock == ClockKind::kWork;
}

std::unique_ptr<FrameClock> make_frame_clock(const SessionSettings& settings, int rank,
                                             const SequenceClock& sequence, std::size_t region_pixels,
                                             double ranks_per_core, bool refreshes_in_parts) {
  if (is_reproducible(settings)) {
    return std::make_unique<WorkClock>(budget(settings), region_pixels, slowness_of(settings.machine, rank));
  }
  return std::make_unique<WallClock>(sequence, period_s(settings), ranks_per_core, refreshes_in_parts);
}

std::unique_ptr<ExchangePolicy> make_exchange_policy(const SessionSettings& settings, int ranks) {
  if (is_reproducible(settings))
    return std::make_unique<LockstepExchange>(ranks, settings.machine, units_per_round(settings));
  return std::make_unique<FreeExchange>(period_s(settings));
}

std::unique_ptr<DeliveryClock> make_delivery_clock(const SessionSettings& settings, double ranks_per_core,
                                                   std::function<double()> now) {
  const double rate = settings.frames_per_second;
  if (is_reproducible(settings)) return std::make_unique<WorkDeliveryClock>(rate, settings.budget_units);
  return std::make_unique<WallDeliveryClock>(rate, ranks_per_core, settings.awaits_all, std::move(now));
}

}  // namespace pprt
