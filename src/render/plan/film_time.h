// A film's whole time, divided among its frames so that the worst error is least
// (docs/decisions/0035-quality.md).
//
// A quick pass of equal times prices the frames: it measures how wrong each of them is then. The pass proper
// gives more time to those that need more.
#pragma once

#include <span>
#include <vector>

#include "parallel/master/measured_error.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// What a frame's error was in the quick pass.
struct FramePrice {
  ErrorEstimate error;
  bool cut = false;  // a shot begins
};

// Share of a film's time that the quick pass takes.
inline constexpr double kPricingShare = 0.1;

// Returns the settings of a pass of `frames` frames in so many seconds.
SessionSettings pass_settings(const SessionSettings& film, int frames, double seconds);

// Returns those of the quick pass, in which more eye rays measure.
SessionSettings pricing_settings(const SessionSettings& film, int frames, double film_time);

// Returns the time of each frame, by the mean of all, from the prices of all frames in order. Frames whose
// error is known roughly are priced together with those next to them in the shot, and nearer to the mean.
std::vector<double> divided_time(std::span<const FramePrice> prices);

}  // namespace pprt
