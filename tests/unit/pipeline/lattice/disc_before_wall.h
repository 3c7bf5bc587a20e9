// Shapes that tests of the lattice share.
#pragma once

#include <cstdint>

#include "pipeline/visibility/visibility_buffer.h"

namespace pprt::test {

// A disc about (x, y), primitive 2, before a wall, primitive 1. All are pixels.
inline PrimitiveShapes disc_before_wall(double x, double y, double radius) {
  const auto project = [=](std::uint32_t primitive, ImageShape& shape) {
    constexpr double kNear = 1e-6;
    constexpr float kFar = 1e9F;
    shape.facets.clear();
    if (primitive == 1) {
      shape.kind = ImageShape::Kind::kFacets;
      shape.facets = {{{{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}}, {1, 0, 0}, {-kFar, -kFar, kFar, kFar}}};
      return;
    }
    shape.kind = ImageShape::Kind::kQuadric;
    shape.quadric.discriminant = {
        kNear * (radius * radius - x * x - y * y), kNear * 2 * x, kNear * 2 * y, -kNear, 0, -kNear};
    shape.quadric.middle = {-2, 0, 0};
  };
  return {project, 2};
}

}  // namespace pprt::test
