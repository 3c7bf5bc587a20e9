// Upright rectangles parallel to the image as shapes that a visibility buffer sees.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/visibility/visibility_buffer.h"

namespace pprt::test {

// Pixels. Each is a primitive of two triangles.
struct Rectangle {
  double x0, y0, x1, y1, nearness;
};

inline ImageFacet triangle(const std::array<Vec2d, 3>& corners, double nearness) {
  ImageFacet facet;
  facet.bounds = {1e9F, 1e9F, -1e9F, -1e9F};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2d &a = corners[i], &b = corners[(i + 1) % 3];
    facet.edges[i] = {a.x * b.y - a.y * b.x, a.y - b.y, b.x - a.x};
    const auto x = static_cast<float>(a.x), y = static_cast<float>(a.y);
    ImageBounds& box = facet.bounds;
    box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x), std::max(box.y1, y)};
  }
  facet.nearness = {nearness, 0, 0};
  return facet;
}

// Primitives from 1 on.
inline PrimitiveShapes shapes_of(const std::vector<Rectangle>& rectangles) {
  return {[rectangles](std::uint32_t primitive, ImageShape& shape) {
            const Rectangle& r = rectangles.at(primitive - 1);
            shape.kind = ImageShape::Kind::kFacets;
            shape.facets = {triangle({{{r.x0, r.y0}, {r.x1, r.y0}, {r.x0, r.y1}}}, r.nearness),
                            triangle({{{r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}}}, r.nearness)};
          },
          static_cast<std::uint32_t>(rectangles.size())};
}

// Returns the primitive that is seen at a point; 0: none.
inline std::uint32_t seen_at(const std::vector<Rectangle>& rectangles, double x, double y) {
  std::uint32_t seen = 0;
  double nearest = 0;
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    const Rectangle& r = rectangles[i];
    if (x < r.x0 || x > r.x1 || y < r.y0 || y > r.y1 || r.nearness <= nearest) continue;
    nearest = r.nearness, seen = static_cast<std::uint32_t>(i + 1);
  }
  return seen;
}

}  // namespace pprt::test
