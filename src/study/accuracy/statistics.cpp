#include "study/accuracy/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/report/plot.h"

namespace pprt {

Spread spread_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  if (values.empty()) return {kNoValue, kNoValue, kNoValue};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

double mean_of(std::span<const double> values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double geometric_mean(std::span<const double> values) {
  double sum = 0;
  int count = 0;
  for (const double v : values) {
    if (!std::isnan(v)) sum += std::log(v), ++count;
  }
  return count == 0 ? kNoValue : std::exp(sum / count);
}

double log_linear(double x, double x0, double y0, double x1, double y1) {
  if (x1 == x0 || x0 <= 0 || y0 <= 0 || y1 <= 0) return y1;
  return y0 * std::pow(y1 / y0, std::log(x / x0) / std::log(x1 / x0));
}

}  // namespace pprt
