// What Assimp leaves out of glTF files, and what its versions read in several ways.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/scene_description.h"

namespace pprt {

// Adds the scene's camera and its lights (KHR_lights_punctual) to a file, to the nodes that have their names:
// "camera", "light_1" and so on. `bytes`: of a .glb or a .gltf.
//
// Lights of glTF weaken with the distance. They are as bright as the scene's own at the middle of the scene.
// Throws std::runtime_error when the file is not as Assimp writes it.
void add_camera_and_lights(std::string& bytes, const SceneDescription& scene);

// Returns the vertical angle of the camera of a node, in radians. Empty where the file has no such node, or
// its camera is not a perspective one. `bytes`: of a .glb or a .gltf.
std::optional<double> camera_angle(std::string_view bytes, std::string_view node);

}  // namespace pprt
