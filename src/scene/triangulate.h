// Polygons, concave ones too, as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pprt {

using TriangleIndices = std::array<std::uint32_t, 3>;  // of the polygon's vertices, in its own winding

// Twice the vector area (Newell): along the normal of a planar polygon, robust against collinear corners.
Vec3d newell_normal(std::span<const Vec3d> polygon);

// Covers a simple polygon by triangles over its own vertices: ear clipping on the plane of its largest
// projection, the best shaped ear first. Duplicate and collinear vertices take no triangle; a non-planar
// polygon is cut as its projection is; one that crosses itself is covered somehow. Empty for no area.
// Quadratic in the number of vertices.
std::vector<TriangleIndices> triangulate(std::span<const Vec3d> polygon);

}  // namespace pprt
