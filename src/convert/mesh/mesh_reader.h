// Reading mesh files of modelling programs.
#pragma once

#include <cstdint>
#include <string>

#include "convert/model/read_mesh.h"
#include "parser/text/reading_memory.h"

namespace pprt {

// Whether files of this extension (".obj", lower case) can be read. NFF files are left to the parser.
bool is_mesh_extension(const std::string& extension);

struct MeshOptions {
  std::uint64_t max_memory = usual_reading_memory();
  std::string animation = {};  // the name of the one that is shown; empty: the first of glTF, else all
};

// Reads polygons, materials, camera and lights, in world space: glTF by tinygltf, the others by Assimp.
// Polygons have normals where these differ from their plane's. Throws InputError: the file is missing, it
// cannot be read, or it has no polygon.
ReadMesh read_mesh(const std::string& path, const MeshOptions& options = {});

}  // namespace pprt
