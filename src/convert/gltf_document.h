// What Assimp leaves out of glTF files, and what its versions read in several ways.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "scene/scene_description.h"

namespace pprt {

// Returns the name of the node of a light; from 0.
inline std::string light_name(std::size_t light) {
  return "light_" + std::to_string(light + 1);
}

// Returns a name without the bytes that are not UTF-8, which JSON cannot hold.
std::string utf8(std::string name);

// Adds the scene's camera and its lights (KHR_lights_punctual) to a file, to the nodes "camera" and
// light_name(). `bytes`: of a .glb or a .gltf.
//
// Lights of glTF weaken with the distance. They are as bright as the scene's own at the middle of the scene.
// Throws std::runtime_error when the file is not as Assimp writes it.
void add_camera_and_lights(std::string& bytes, const SceneDescription& scene);

// Returns why a file should not be read; empty where nothing is found. Assimp would go through nodes without
// end, or take keys of whole numbers for others. `bytes`: of a .glb or a .gltf.
std::string document_problem(std::string_view bytes);

// Returns the vertical angle of the camera of a node, in radians. Empty where the file has no such node, or
// its camera is not a perspective one. `bytes`: of a .glb or a .gltf.
std::optional<double> camera_angle(std::string_view bytes, std::string_view node);

}  // namespace pprt
