// Materials as Assimp has them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/description/scene_description.h"

struct aiMaterial;
struct aiMesh;

namespace pprt {

// Returns the material, without its texture. The one that Assimp adds to meshes without one becomes NFF's
// default, white and matte.
Material to_material(const aiMaterial& from);

// Returns the path of the picture that colours a material as its file has it, or "*N" for the N-th within the
// file; empty without.
std::string picture_path(const aiMaterial& from);

// Returns the same of the picture that its light has.
std::string emission_path(const aiMaterial& from);

// Whether it has a normal map or a bump map.
bool has_normal_map(const aiMaterial& from);

// Whether it has pictures that a scene cannot hold, besides a normal map.
bool has_other_pictures(const aiMaterial& from);

// Returns the display values of a mesh's colours at its vertices; empty without.
std::vector<Rgb> vertex_colors(const aiMesh& from);

// Paths of a material's pictures, as picture_path() returns them.
struct MaterialPictures {
  std::string color, emission;
};

// Returns a material for a file. Phong's model is that of NFF without the mirror. Formats with only
// physically based materials get smooth metal for it. They hold an emission of at most 1. `thickness`: of
// what lets light through, in units of its mesh; without one it would be a thin wall there.
std::unique_ptr<aiMaterial> to_assimp(const Material& material, const std::string& name,
                                      bool physically_based, const MaterialPictures& pictures,
                                      double thickness);

}  // namespace pprt
