// Which way three points of a plane turn.
#pragma once

#include "base/vector.h"

namespace pprt {

// Returns twice the signed area of a triangle; positive when a, b, c run counter-clockwise.
inline double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace pprt
