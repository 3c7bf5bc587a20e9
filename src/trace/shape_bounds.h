// Boxes about primitives in the image, cheaper than their projections: what lies outside of a region need not
// be projected.
#pragma once

#include <cstdint>
#include <span>

#include "base/camera.h"
#include "base/image_shape.h"
#include "trace/pose.h"

namespace pprt {

// Replaces `bounds` by those of as many primitives after the first `first` ones, in the order of their
// numbers.
void bound_primitives(const Pose& pose, std::uint32_t first, const Camera& camera,
                      std::span<ShapeBounds> bounds);

}  // namespace pprt
