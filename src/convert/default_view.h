// A view and lights for a scene that has none.
#pragma once

#include <vector>

#include "base/words.h"
#include "scene/description/scene_description.h"

namespace pprt {

enum class UpAxis { kY, kZ };

template <>
inline constexpr std::array<Word<UpAxis>, 2> kWords<UpAxis>{{{UpAxis::kY, "y", ""}, {UpAxis::kZ, "z", ""}}};

// Returns a view of the whole scene from its front, half right and above, with the axis upright. What is seen
// lies in the middle, with even margins. The scene must have objects, which rest.
View fitted_view(const SceneDescription& scene, UpAxis up);

// Returns a key light, left of the viewer and above, and a fill light to the right, both white. With the
// ambient light they give a grey surface most of the range of display values.
std::vector<Light> default_lights(const SceneDescription& scene, const View& view);

}  // namespace pprt
