// Reading mesh files of modelling programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parser/text/reading_memory.h"
#include "scene/description/scene_description.h"

namespace pprt {

// Whether files of this extension (".obj", lower case) can be read. NFF files are left to the parser.
bool is_mesh_extension(const std::string& extension);

struct ReadMesh {
  SceneDescription scene;          // named as the file; without view or lights when the file has none
  std::vector<std::string> notes;  // for people: what was left out or approximated
  std::vector<std::string> files;  // all that were opened, by path
};

// Reads polygons, materials, camera and lights, in world space. Polygons have normals where these differ from
// their plane's. Throws InputError: the file is missing, Assimp rejects it, or it has no polygon.
ReadMesh read_mesh(const std::string& path, std::uint64_t max_memory = usual_reading_memory());

}  // namespace pprt
