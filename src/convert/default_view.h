// A view and a light for what comes without.
#pragma once

#include "scene/scene_description.h"

namespace pprt {

enum class UpAxis { kY, kZ };

// A view of the whole scene from its front, half right and above, upright along the axis. The scene must have
// objects.
View fitted_view(const SceneDescription& scene, UpAxis up);

// A white light behind the viewer's left shoulder.
Light default_light(const SceneDescription& scene, const View& view);

}  // namespace pprt
