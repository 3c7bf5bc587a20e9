// Sorts a scene's primitives into parts: those of one body and kind with the same visible faces.
#pragma once

#include "scene/description/scene_description.h"
#include "trace/scene_impl.h"

namespace pprt {

// Fills the scene's bodies and parts. The world's normalisation must be set. Throws InputError for numbers
// that are not finite.
void build_parts(const SceneDescription& scene, CompiledScene::Impl& impl);

}  // namespace pprt
