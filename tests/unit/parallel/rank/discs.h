// Frames of a plane full of discs, for tests of what ends a frame and of what measures it.
#pragma once

#include <cstdint>

#include "unit/parallel/virtual_run.h"

namespace pprt {

inline constexpr double kDiscPeriod = 2.3;  // scene units

inline Conditions discs() {
  Conditions conditions;
  conditions.period = kDiscPeriod;
  return conditions;
}

// Of frames that end by a rule.
inline SessionSettings settings_until(const StopRules& stop, SamplerChoice sampler) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 192, settings.height = 128;
  settings.clock = ClockKind::kWork;
  settings.cast = CastChoice::kOff;
  settings.stop = stop;
  return settings;
}

inline std::uint64_t samples_of(const FinishedFrame& frame) {
  std::uint64_t sum = 0;
  for (const RankReport& rank : frame.ranks) sum += rank.samples_in_region;
  return sum;
}

}  // namespace pprt
