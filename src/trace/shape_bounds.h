// Boxes about primitives in the image, cheaper than their projections: what lies outside of a region need not
// be projected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/camera.h"
#include "base/image_shape.h"
#include "trace/pose.h"

namespace pprt {

// Boxes about each so many triangles of a mesh, in its space.
inline constexpr std::size_t kTrianglesInBox = 32;
std::vector<Box3d> boxes_of(const Mesh& mesh);

// Replaces `bounds` by those of as many primitives after the first `first` ones, in the order of their
// numbers. What is outside the image may have none.
void bound_primitives(const Pose& pose, std::uint32_t first, const Camera& camera,
                      std::span<ShapeBounds> bounds);

}  // namespace pprt
