// Points of a pixel at which the shares of what is seen in it are counted. Private to the room.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/simd.h"
#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {

// Points of a pixel, in shares of its side: Sobol's first two dimensions, whose beginnings fall evenly, too.
inline constexpr int kMostSharePoints = 256, kMostShareVectors = kMostSharePoints / kPoints;

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

// What is nearest at each point of a pixel: a number of its own, 0 for nothing.
class NearestInPixel {
 public:
  explicit NearestInPixel(int points);

  // Shows a shape where it is nearer. `left`, `top`: the pixel's corner.
  template <class Shape>
  PPRT_CLONED_FOR_WIDE_REGISTERS void show(const Shape& shape, float left, float top, std::int32_t number) {
    for (std::size_t i = 0; i < vectors_; ++i) {
      const PerPoint n = nearness(shape, load<PerPoint>(kSharePoints[0].data() + i * kPoints) + left,
                                  load<PerPoint>(kSharePoints[1].data() + i * kPoints) + top);
      const auto is_nearer = n > nearest_[i];
      nearest_[i] = is_nearer ? n : nearest_[i];
      numbers_[i] = is_nearer ? Numbers{} + number : numbers_[i];
    }
  }

  // Replaces `counts` by how many points show each number, from 0 on.
  void count(std::span<int> counts) const;

 private:
  using Numbers = std::int32_t __attribute__((vector_size(kPoints * sizeof(std::int32_t))));

  std::size_t vectors_;
  std::array<PerPoint, kMostShareVectors> nearest_;
  std::array<Numbers, kMostShareVectors> numbers_;
};

}  // namespace pprt
