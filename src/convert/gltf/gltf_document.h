// What Assimp leaves out when it writes glTF files, and what is wrong with those that are read.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

// Returns the least square of a distance that a light of glTF counts with: it is not dark within the scene.
double least_distance2(const Box3d& scene);

// What readers do not tell of a file.
struct GltfFacts {
  // Why it should not be read: a length beyond the file, brackets or nodes without end. Empty: nothing was
  // found.
  std::string problem;
  // Why it may be that it cannot be read, which may have other reasons too. Empty: nothing was found.
  std::string likely_cause;
  std::optional<std::size_t> broken_at;      // the byte of the likely cause, in a .gltf
  std::size_t json_begin = 0, json_end = 0;  // where its JSON lies
  // Channels of animations that move what is no place of a node, which tinygltf 2.7 passes over.
  struct Pointer {
    std::size_t animation = 0;
    int sampler = 0;
    std::string target;
  };
  std::vector<Pointer> pointers;
  std::map<std::string, std::size_t> buffers;  // the lengths of those in other files, by their URIs
};

// Returns what can be found. `bytes`: of a .glb or a .gltf.
GltfFacts gltf_facts(std::string_view bytes);

}  // namespace pprt
