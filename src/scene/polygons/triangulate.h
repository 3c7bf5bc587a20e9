// Triangulation of polygons, concave ones included.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pprt {

using TriangleIndices =
    std::array<std::uint32_t, 3>;  // indices of the polygon's vertices, in its own winding

// Returns twice the vector area (Newell). It points along the normal of a planar polygon and tolerates
// collinear vertices.
Vec3d newell_normal(std::span<const Vec3d> polygon);

// Triangulates a simple polygon over its own vertices by ear clipping. Works in the coordinate plane of the
// largest projection and clips the best-shaped ear first.
//
// Duplicate and collinear vertices take no triangle. A non-planar polygon is cut as its projection is. A
// self-intersecting one gets some cover. Returns nothing for no area. Takes n log n for n vertices in all but
// contrived polygons.
std::vector<TriangleIndices> triangulate(std::span<const Vec3d> polygon);

}  // namespace pprt
