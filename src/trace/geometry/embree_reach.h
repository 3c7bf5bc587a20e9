// What reaches Embree: places of objects, and rays in the space of a body.
//
// Embree multiplies up to three lengths in float, and asserts that no coordinate of a ray exceeds 1.8e18. It
// inverts the map of an instance in float, through its determinant. The bounds keep all that in the range of
// float. Test: far_objects_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/affine.h"
#include "base/vector.h"

namespace pprt {

// Largest coordinate of anything that rays meet or start from, in the compiled space. Counted from: the cube
// is 2^120, and float ends at 2^128.
inline constexpr double kFarthestPlace = 0x1p40;

// Largest coordinate of a ray in a body's space. Counted from: Embree's bound is 2^60.6.
inline constexpr double kFarthestInBody = 0x1p60;

// Least determinant of a body's map, and the largest of its inverse. Counted from: float is exact to 24 bits
// from 2^-126 on, and Embree also takes the reciprocal.
inline constexpr double kLeastDeterminant = 0x1p-120;

// Farthest light. Its direction is that of any light beyond, to 2^-60. Counted from: squares of lengths stay
// finite in float.
inline constexpr double kFarthestLight = 0x1p60;

// Whether all corners of a box lie in reach; false for one that is not finite.
inline bool is_in_reach(const Box3d& box) {
  const auto within = [](double x) { return std::abs(x) <= kFarthestPlace; };
  return within(box.min.x) && within(box.min.y) && within(box.min.z) && within(box.max.x) &&
         within(box.max.y) && within(box.max.z);
}

// Whether Embree can take rays from anywhere within `radius` of the origin into a body's space. `to_world` is
// the body's map, `from_world` its inverse, `box` the body's place in the world.
inline bool is_in_reach(const Affine& to_world, const Affine& from_world, const Box3d& box, double radius) {
  const double stretch = std::sqrt(from_world.x.length2() + from_world.y.length2() + from_world.z.length2());
  const double volume = std::abs(to_world.determinant());
  return is_in_reach(box) && volume >= kLeastDeterminant && volume * kLeastDeterminant <= 1 &&
         stretch * std::max(1.0, radius + to_world.origin.length()) <= kFarthestInBody;
}

// Returns a light's position, or one in the same direction that is in reach. `from_center` is relative to the
// compiled space's origin, and multiplied by `scale`.
inline Vec3d light_in_reach(const Vec3d& from_center, double scale) {
  const double largest =
      std::max({std::abs(from_center.x), std::abs(from_center.y), std::abs(from_center.z)});
  return from_center * (largest * scale > kFarthestLight ? kFarthestLight / largest : scale);
}

// Returns the place of a sun. From anywhere in reach it is seen in the same direction, to 2^-20.
inline Vec3d sun_in_reach(const Vec3d& direction) {
  const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  return direction / largest * kFarthestLight;
}

}  // namespace pprt
