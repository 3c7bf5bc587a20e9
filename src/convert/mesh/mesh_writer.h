// Writing a scene as triangles in the formats of modelling programs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "convert/surfaces/tessellate.h"
#include "scene/description/scene_description.h"

namespace pprt {

// Returns the extensions that can be written, with their dots.
const std::vector<std::string>& mesh_output_extensions();

// Whether a format of an extension that can be written has movement, and textures.
bool keeps_movement(std::string_view extension);
bool keeps_textures(std::string_view extension);

// One file: OBJ comes with a .mtl beside it, glTF with a .bin.
struct MeshFile {
  std::string name;  // without a folder
  std::string bytes;
};

struct WrittenMesh {
  std::vector<MeshFile> files;  // the named one last, after those that it refers to
  std::size_t triangles = 0;
  std::size_t degenerate = 0;  // primitives of no extent, left out
};

// Returns the scene as one mesh for each material in each node, in the scene's own axes, with normals at the
// vertices of smooth surfaces. Materials, textures, camera, lights and movement are included where the format
// has them. Nothing else may move, and no triangle may change its shape (still_at()). `stem` is the name of
// the file without its extension, by which its parts refer to each other. Throws InputError for no triangles,
// more than kMaxTriangles, or a degenerate view; std::runtime_error when Assimp cannot write it.
WrittenMesh write_mesh(const SceneDescription& scene, std::string_view extension, const std::string& stem,
                       const Fineness& fineness);

}  // namespace pprt
