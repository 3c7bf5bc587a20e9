#include "image/plane.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace pprt {

Kernel gaussian(int taps, double sigma) {
  Kernel weights(static_cast<std::size_t>(taps));
  for (int i = 0; i < taps; ++i) {
    const double offset = (i - 0.5 * (taps - 1)) / sigma;
    weights[static_cast<std::size_t>(i)] = std::exp(-0.5 * offset * offset);
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

// Adds whole rows, tap by tap. The compiler can vectorise the loop, and each pixel's sum keeps its order.
Plane filtered(const Plane& plane, const Kernel& across, const Kernel& down) {
  const int width = plane.width - static_cast<int>(across.size()) + 1;
  const int height = plane.height - static_cast<int>(down.size()) + 1;
  const auto columns = static_cast<std::size_t>(width);
  const auto add_row = [columns](double* sums, const double* row, double weight) {
    for (std::size_t x = 0; x < columns; ++x) sums[x] += weight * row[x];
  };

  std::vector<double> rows(columns * static_cast<std::size_t>(plane.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(plane.height); ++y) {
    const double* row = plane.values.data() + y * static_cast<std::size_t>(plane.width);
    for (std::size_t i = 0; i < across.size(); ++i) add_row(rows.data() + y * columns, row + i, across[i]);
  }
  Plane result{width, height, std::vector<double>(columns * static_cast<std::size_t>(height))};
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    double* sums = result.values.data() + y * columns;
    for (std::size_t i = 0; i < down.size(); ++i) add_row(sums, rows.data() + (y + i) * columns, down[i]);
  }
  return result;
}

Plane with_margin(const Plane& plane, int margin) {
  Plane result{plane.width + 2 * margin, plane.height + 2 * margin, {}};
  result.values.reserve(static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height));
  for (int y = -margin; y < plane.height + margin; ++y) {
    const auto line = static_cast<std::size_t>(std::clamp(y, 0, plane.height - 1));
    const double* row = plane.values.data() + line * static_cast<std::size_t>(plane.width);
    for (int x = -margin; x < plane.width + margin; ++x) {
      result.values.push_back(row[std::clamp(x, 0, plane.width - 1)]);
    }
  }
  return result;
}

}  // namespace pprt
