// Circles through three points, with what rounding may have done to them.
#pragma once

#include <cmath>

#include "base/vector.h"

namespace pprt {

// The circle through a triangle's corners, seen from one of them: whoever keeps it knows which.
struct Circumcircle {
  double diameter_x = 0, diameter_y = 0;  // from that corner to the opposite point of the circle, pixels
  float slack = 0;  // how far a component of the diameter may be off, and a little more; may be infinite
  float size_squared = 0;  // of the radius or, where that is less, the longest edge; square pixels

  Vec2d to_center() const { return {0.5 * diameter_x, 0.5 * diameter_y}; }
  double radius_squared() const { return 0.25 * (diameter_x * diameter_x + diameter_y * diameter_y); }
};

// Whether the circle holds a point, given from the same corner: it does where the diameter is seen at an
// obtuse angle (Thales). 1 inside, -1 outside, 0 where rounding may decide.
inline int side_of_circle(const Circumcircle& circle, const Vec2d& from_corner) {
  constexpr double kRounding = 8 * 0x1p-53, kUnderflow = 1e-280;
  const Vec2d& q = from_corner;
  const double product = q.x * (q.x - circle.diameter_x) + q.y * (q.y - circle.diameter_y);
  const double way = std::abs(q.x) + std::abs(q.y);
  const double bound = way * (circle.slack + kRounding * way) + kUnderflow;
  if (product < -bound) return 1;
  if (product > bound) return -1;
  return 0;
}

}  // namespace pprt
