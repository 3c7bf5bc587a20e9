// Points of a pixel at which the shares of what is seen in it are counted. Private to the room.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pipeline/core/simd.h"
#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {

// Points of a pixel, in shares of its side: Sobol's first two dimensions, whose beginnings fall evenly, too.
inline constexpr int kMostSharePoints = 64, kMostShareVectors = kMostSharePoints / kPoints;
using SharePoints = std::array<PerPoint, kMostShareVectors>;

constexpr float share_point(std::uint32_t i, bool is_second) {
  std::uint32_t bits = 0;
  for (std::uint32_t direction = 1U << 31; i != 0;
       i >>= 1, direction = is_second ? direction ^ direction >> 1 : direction >> 1)
    if ((i & 1U) != 0) bits ^= direction;
  return static_cast<float>(bits >> 8) * 0x1p-24F + 0.5F / kMostSharePoints;
}

inline constexpr std::array<std::array<float, kMostSharePoints>, 2> kSharePoints = [] {
  std::array<std::array<float, kMostSharePoints>, 2> points{};
  for (std::size_t i = 0; i < kMostSharePoints; ++i)
    points[0][i] = share_point(static_cast<std::uint32_t>(i), false),
    points[1][i] = share_point(static_cast<std::uint32_t>(i), true);
  return points;
}();

// Raises `nearest` to the nearness of a shape at the points of a pixel with this upper left corner.
template <class Shape>
PPRT_CLONED_FOR_WIDE_REGISTERS void raise_nearness(const Shape& shape, float left, float top,
                                                   std::span<PerPoint> nearest) {
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const PerPoint n = nearness(shape, load<PerPoint>(kSharePoints[0].data() + i * kPoints) + left,
                                load<PerPoint>(kSharePoints[1].data() + i * kPoints) + top);
    nearest[i] = n > nearest[i] ? n : nearest[i];
  }
}

}  // namespace pprt
