// What reading a model gives.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene_description.h"

namespace pprt {

struct ReadMesh {
  SceneDescription scene;          // named as the file; without view or lights when the file has none
  std::vector<std::string> notes;  // for people: what was left out or approximated
  std::vector<std::string> files;  // all that were opened, by path
};

// Levels of nodes in each other that can be read.
inline constexpr int kMaxNodeDepth = 1000;

}  // namespace pprt
