// Projects primitives of a compiled scene to the image.
#pragma once

#include <cstdint>

#include "base/camera.h"
#include "base/image_shape.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Writes the projection of a primitive, counted from 1 as in RaySample, into `shape`, whose storage is
// reused. There are no facets where it has no extent or is not shown.
void project_primitive(const Pose& pose, std::uint32_t primitive, const Camera& camera, ImageShape& shape);

}  // namespace pprt
