// Names of the pictures that are written beside a scene for its textures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/description/scene_description.h"

namespace pprt {

// Returns "STEM-wood.png" for a texture "wood.ppm", or "STEM-wood-2.png" and so on where that is taken.
// Blanks and characters that formats give a meaning become '_'.
std::string picture_name(const std::string& stem, const Texture& texture,
                         const std::function<bool(const std::string&)>& is_taken);

// Returns a distinct name for each texture of the scene.
std::vector<std::string> picture_names(const SceneDescription& scene, const std::string& stem);

}  // namespace pprt
