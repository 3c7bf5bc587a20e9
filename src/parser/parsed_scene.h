// What a scene's parser returns.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene_description.h"

namespace pprt {

// A scene, the warnings of its reading and all files that were opened for it.
struct ParsedScene {
  SceneDescription scene;
  std::string warnings = {};  // formatted with their places, each line ended; empty when there are none
  std::vector<std::string> files = {};           // by path; "/dev/stdin" for standard input
  std::vector<std::string> texture_places = {};  // "file:line:column" where each texture is named first
};

}  // namespace pprt
