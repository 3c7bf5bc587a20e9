// The planner: answers, in a sentence, which frame rate goes with which error.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/accuracy/rates.h"
#include "study/rate/held_rates.h"

namespace pprt {

// Names the error at a rate, or the rate that has an error, from points of one scene and one way of casting
// by increasing rate. Interpolates in logarithms. Throw std::invalid_argument without points.
std::string error_at_rate(const std::vector<RatePoint>& points, double fps);
std::string rate_with_error(std::vector<RatePoint> points, double rmse);

// Describes what a viewer sees who looks at each frame until the next is delivered: at the first rate, and at
// the others for comparison. Throws std::invalid_argument without results.
std::string seen_at_rates(const std::string& scene, std::span<const RateResult> results);

// One turn of measurements in real time, of the same sequence.
struct RealTimeTurn {
  RealTimePoint with, without;  // casting
  MeanErrors uniform = {};      // of uniform grids in all of the ranks' time
};

// Describes what a sequence did in real time. The error is the median over the turns; the ratios are medians
// of the turns' ratios. Throws std::invalid_argument without turns.
std::string real_time_summary(std::span<const RealTimeTurn> turns);

}  // namespace pprt
