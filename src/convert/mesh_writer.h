// Writing a scene as triangles in formats that modelling programs read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "convert/tessellate.h"
#include "scene/scene_description.h"

namespace pprt {

// Extensions that can be written, with their dots.
const std::vector<std::string>& mesh_output_extensions();

// One file: OBJ comes with a .mtl beside it, glTF with a .bin.
struct MeshFile {
  std::string name;  // without a folder
  std::string bytes;
};

struct WrittenMesh {
  std::vector<MeshFile> files;  // the named one last, so that what it refers to is there before it
  std::size_t triangles = 0;
  std::size_t degenerate = 0;  // primitives of no extent, left out
};

// The scene as one mesh a material, normals at the vertices of what is smooth, in the scene's own axes, with
// materials, camera and lights where the format has them. `stem`: of the file's name, by which its parts
// refer to each other. Throws InputError when there is nothing to write, more than kMaxTriangles, or a view
// that is degenerate; std::runtime_error when Assimp cannot write it.
WrittenMesh write_mesh(const SceneDescription& scene, std::string_view extension, const std::string& stem,
                       const Fineness& fineness);

}  // namespace pprt
