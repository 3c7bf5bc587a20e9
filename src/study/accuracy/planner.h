// The planner: answers, in a sentence, which frame rate goes with which error.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/accuracy/rates.h"

namespace pprt {

// Names the error at a rate, or the rate that has an error, from points of one scene and one way of casting
// by increasing rate. Interpolates in logarithms. Throw std::invalid_argument without points.
std::string error_at_rate(const std::vector<RatePoint>& points, double fps);
std::string rate_with_error(std::vector<RatePoint> points, double rmse);

// One turn of measurements in real time, of the same sequence.
struct RealTimeTurn {
  RealTimePoint with, without;  // casting
  MeanErrors uniform = {};      // of uniform grids in all of the ranks' time
};

// Describes what a sequence did in real time. The error is the median over the turns; the ratios are medians
// of the turns' ratios. Throws std::invalid_argument without turns.
std::string real_time_summary(std::span<const RealTimeTurn> turns);

}  // namespace pprt
