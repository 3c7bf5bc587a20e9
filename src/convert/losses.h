// What other formats do not have of a scene, and what comes closest.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene_description.h"

namespace pprt {

// A scene that a format can hold, and what it differs in.
struct PlainScene {
  SceneDescription scene;
  std::vector<std::string> losses;  // a line each
};

// Returns the scene for NFF: no textures but their mean colours, no emission, no sky, suns as lights far
// away. Lights have the brightness as written when a reader of NFF weakens them.
PlainScene for_nff(SceneDescription scene);

// Returns the scene for meshes: no ambient light, and where the format has no textures their mean colours.
PlainScene for_meshes(SceneDescription scene, bool keeps_textures);

}  // namespace pprt
