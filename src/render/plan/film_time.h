// A film's whole time, divided among its frames so that the worst error is least
// (docs/decisions/0035-quality.md).
//
// A quick pass prices the frames: it measures how wrong some of them are after equal times. The pass proper
// gives more time to those that need more.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "parallel/master/master.h"
#include "parallel/master/measured_error.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// Share of a film's time that the quick pass takes.
inline constexpr double kPricingShare = 0.04;

// Returns the settings of a pass of `frames` frames in so many seconds.
SessionSettings pass_settings(const SessionSettings& film, std::size_t frames, double seconds);

// Returns the frames of the quick pass: one for each four that follow each other in a shot.
std::vector<FrameRequest> pricing_requests(std::span<const FrameRequest> film);

// Returns the settings of the quick pass of so many frames, in which more eye rays measure.
SessionSettings pricing_settings(const SessionSettings& film, std::size_t frames, double film_time);

// Returns the time of each frame of a film, by the mean of all, from the errors of pricing_requests(film).
// Frames whose error is known roughly are priced together with those next to them in the shot, and nearer to
// the mean.
std::vector<double> divided_time(std::span<const FrameRequest> film, std::span<const ErrorEstimate> prices);

}  // namespace pprt
