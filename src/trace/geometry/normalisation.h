// The map from scene space to the compiled space.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"

namespace pprt {

// Moves and scales a box so that its largest extent lies in (0.5, 1].
//
// The scale is a power of two and rounds nothing. Moving rounds each coordinate once, by at most 2^-53 of its
// result. Test: compile_test.cpp, "normalising fits any box ...".
struct Normalisation {
  Vec3d center{0, 0, 0};
  double scale = 1;

  // Each maps a point or a length of scene space to the compiled space.
  Vec3d point(const Vec3d& p) const { return (p - center) * scale; }
  double length(double l) const { return l * scale; }
};

// Returns the map of a box. `box` must be finite and not empty; `center`, a point in it, becomes the origin.
// A box without extent keeps the scale 1. The scale stays finite where the box is smaller than 2^-1000.
inline Normalisation normalising(const Box3d& box, const Vec3d& center) {
  Normalisation result;
  result.center = center;
  const Vec3d size = box.max - box.min;
  const double largest = std::max({size.x, size.y, size.z});
  if (largest > 0) {
    int exponent = 0;
    const double mantissa = std::frexp(largest, &exponent);  // in [0.5, 1); largest = mantissa * 2^exponent
    result.scale = std::ldexp(1.0, std::min(1000, mantissa == 0.5 ? 1 - exponent : -exponent));
  }
  return result;
}

// The same with the middle of the box as the origin.
inline Normalisation normalising(const Box3d& box) {
  return normalising(box, box.min * 0.5 + box.max * 0.5);
}

}  // namespace pprt
