// The circle through three points, with a bound of its rounding errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/vector.h"
#include "pipeline/mesh/refinement_weight.h"

namespace pprt {

// The circle through a triangle's corners, relative to one of them, which the owner knows.
struct Circumcircle {
  double diameter_x = 0, diameter_y = 0;  // from that corner to the opposite point of the circle, pixels
  float slack = 0;         // bound of the error of a component of the diameter, pixels; may be infinite
  float size_squared = 0;  // of the radius or the longest edge, whichever is less; square pixels

  Vec2d to_center() const { return {0.5 * diameter_x, 0.5 * diameter_y}; }
  double radius_squared() const { return 0.25 * (diameter_x * diameter_x + diameter_y * diameter_y); }
};

// Error bound of a circle's diameter, in parts of n * parts / cross^2; counted in docs/numerics.md.
inline constexpr double kCircumcircleRounding = 64 * 0x1p-53;

// Computes the circle of a triangle that turns to the left. Corners a and b are relative to the third.
// Scalar twin of circumcircles() in delaunay.cpp: equal to the bit.
inline Circumcircle circumcircle(const Vec2d& a, const Vec2d& b) {
  const double cross = a.x * b.y - a.y * b.x;
  const double a2 = a.dot(a), b2 = b.dot(b);
  const Vec2d ab = b - a;
  const double scale = 1 / std::max(cross, kSmallestDoubleArea);
  const double x = (b.y * a2 - a.y * b2) * scale, y = (a.x * b2 - b.x * a2) * scale;
  const double n = (std::abs(a.x) + std::abs(a.y)) * b2 + (std::abs(b.x) + std::abs(b.y)) * a2;
  const double parts = std::abs(a.x * b.y) + std::abs(a.y * b.x);
  const double slack = cross > kSmallestDoubleArea ? kCircumcircleRounding * n * parts * scale * scale
                                                   : std::numeric_limits<double>::infinity();
  const double size_squared = std::min(0.25 * (x * x + y * y), std::max({a2, b2, ab.dot(ab)}));
  return {x, y, static_cast<float>(slack), static_cast<float>(size_squared)};
}

// Returns 1 if the circle holds a point, -1 if not, 0 if rounding might decide. The point is relative to the
// same corner. It is inside where it sees the diameter at an obtuse angle (Thales).
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
