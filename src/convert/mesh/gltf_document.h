// What Assimp leaves out of glTF files, and what its versions read in several ways.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "scene/description/scene_description.h"

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
// Lights of glTF weaken with the distance. At the animation's start they are as bright as the scene's own
// in the middle of the scene.
// Throws std::runtime_error when the file is not as Assimp writes it.
void add_camera_and_lights(std::string& bytes, const SceneDescription& scene);

// What Assimp does not tell of a file, or not rightly.
struct GltfFacts {
  // Why it should not be read: a length beyond the file, brackets or nodes without end, keys of whole
  // numbers. Empty: nothing was found.
  std::string problem;
  // Why Assimp may be unable to read it, which may have other reasons too. Empty: nothing was found.
  std::string likely_cause;
  std::optional<std::size_t> broken_at;  // the byte of the likely cause, in a .gltf
  // Vertical angles of perspective cameras, in radians, by Assimp's names of their nodes. The first of
  // namesakes counts.
  std::map<std::string, double> camera_angles;
};

// Returns what can be found. `bytes`: of a .glb or a .gltf.
GltfFacts gltf_facts(std::string_view bytes);

// Levels of nodes in each other that can be read.
inline constexpr int kMaxNodeDepth = 1000;

}  // namespace pprt
