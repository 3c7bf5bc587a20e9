// Means and interpolation of measured values. NaN is what was not measured.
#pragma once

#include <span>
#include <vector>

namespace pprt {

// Median, least and greatest of the values that are numbers; NaN when there are none.
struct Spread {
  double median, low, high;
};
Spread spread_of(std::vector<double> values);

// 0 of no values.
double mean_of(std::span<const double> values);

// Over the values that are numbers; NaN when there are none.
double geometric_mean(std::span<const double> values);

// Returns y at x on the line through two points, in logarithms; y1 where there is no such line.
double log_linear(double x, double x0, double y0, double x1, double y1);

}  // namespace pprt
