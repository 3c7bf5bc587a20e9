// A view and a light for a scene that has none.
#pragma once

#include "base/words.h"
#include "scene/description/scene_description.h"

namespace pprt {

enum class UpAxis { kY, kZ };

template <>
inline constexpr std::array<Word<UpAxis>, 2> kWords<UpAxis>{{{UpAxis::kY, "y", ""}, {UpAxis::kZ, "z", ""}}};

// Returns a view of the whole scene from its front, half right and above, with the axis upright. The scene
// must have objects.
View fitted_view(const SceneDescription& scene, UpAxis up);

// Returns a white light behind the viewer's left shoulder.
Light default_light(const SceneDescription& scene, const View& view);

}  // namespace pprt
