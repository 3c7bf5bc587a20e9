// Reading meshes of modelling programs.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_description.h"

namespace pprt {

// Whether files of this extension (".obj", lower case) can be read. Not .nff: it is the parser's.
bool is_mesh_extension(const std::string& extension);

struct ReadMesh {
  SceneDescription scene;          // named as the file; without view or lights when the file has none
  std::vector<std::string> notes;  // for people: what was left out or only came near
};

// Polygons, with normals where they say more than the polygon's plane; materials; camera and lights, in world
// space. Throws InputError: the file is missing, Assimp rejects it, or there is no polygon in it.
ReadMesh read_mesh(const std::string& path);

}  // namespace pprt
