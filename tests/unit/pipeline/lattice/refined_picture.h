// Pictures that a lattice makes of an image that is told point by point.
#pragma once

#include <cmath>
#include <optional>

#include "pipeline/lattice/lattice_refiner.h"

namespace pprt::test {

// Returns the picture of a square image after so many samples. sample_at(x, y) returns a RaySample.
template <class SampleAt>
PixelBlock picture_of(LatticeRefiner& refiner, int size, int samples, const SampleAt& sample_at) {
  for (int i = 0; i < samples; ++i) {
    refiner.expect(samples - i);
    const std::optional<Vec2d> point = refiner.next_point();
    if (!point) break;
    refiner.insert(*point, sample_at(point->x, point->y));
  }
  PixelBlock pixels;
  refiner.paint({0, 0, size, size}, pixels);
  return pixels;
}

// Returns the root mean square error from column `from` to before `to`, against 64 points in each pixel.
// color_at(x, y) returns the truth.
template <class ColorAt>
double error_of(const PixelBlock& pixels, int from, int to, const ColorAt& color_at) {
  constexpr int kSide = 8;
  const int size = pixels.bounds.height();
  double sum = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = from; x < to; ++x) {
      Color truth(0, 0, 0);
      for (int i = 0; i < kSide * kSide; ++i)
        truth +=
            color_at(x + (i % kSide + 0.5) / kSide, y + (i / kSide + 0.5) / kSide) * (1.0F / (kSide * kSide));
      const Color d = pixels.at(x, y) - truth;
      sum += d.dot(d) / 3;
    }
  }
  return std::sqrt(sum / (size * (to - from)));
}

}  // namespace pprt::test
