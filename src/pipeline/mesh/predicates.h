// The two geometric predicates of a Delaunay triangulation, exact for all inputs.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"

namespace pprt {

// The same predicates in exact arithmetic (CGAL): called where the filters below cannot decide.
int exact_orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c);
int exact_in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d);

// Returns 1 if a, b, c turn to the left (counter-clockwise with y upwards), -1 if to the right, 0 if they
// are collinear. The filter is Shewchuk's (1997, "Adaptive precision floating-point arithmetic and fast
// robust geometric predicates", s. 4.3: ccwerrboundA); the constant beside it outweighs all underflow.
inline int orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  constexpr double kError = 3.3306690738754716e-16, kUnderflow = 1e-280;
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double determinant = left - right;
  const double bound = kError * (std::abs(left) + std::abs(right)) + kUnderflow;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return exact_orientation(a, b, c);
}

// Returns 1 if d lies inside the circle through a, b, c, which turn to the left; -1 outside, 0 on it. The
// filter is Shewchuk's as well (iccerrboundA).
inline int in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  constexpr double kError = 1.1102230246251577e-15, kUnderflow = 1e-200;
  const Vec2d ad = a - d, bd = b - d, cd = c - d;
  const double a_lift = ad.dot(ad), b_lift = bd.dot(bd), c_lift = cd.dot(cd);
  const double bc = bd.x * cd.y, cb = cd.x * bd.y;
  const double ca = cd.x * ad.y, ac = ad.x * cd.y;
  const double ab = ad.x * bd.y, ba = bd.x * ad.y;
  const double determinant = a_lift * (bc - cb) + b_lift * (ca - ac) + c_lift * (ab - ba);
  const double permanent = a_lift * (std::abs(bc) + std::abs(cb)) + b_lift * (std::abs(ca) + std::abs(ac)) +
                           c_lift * (std::abs(ab) + std::abs(ba));
  const double bound = kError * permanent + kUnderflow;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return exact_in_circle(a, b, c, d);
}

}  // namespace pprt
