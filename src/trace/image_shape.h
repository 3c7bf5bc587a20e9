// Primitives of a compiled scene as an eye sees them.
#pragma once

#include <cstdint>

#include "base/camera.h"
#include "base/image_shape.h"
#include "trace/compiled_scene.h"

namespace pprt {

// The shape of a primitive, counted from 1 as in RaySample, to this camera. Keeps the storage of `shape`.
void view_primitive(const CompiledScene::Impl& scene, std::uint32_t primitive, const Camera& camera,
                    ImageShape& shape);

}  // namespace pprt
