// Materials as Assimp has them.
#pragma once

#include <memory>
#include <string>

#include "scene/description/scene_description.h"

struct aiMaterial;

namespace pprt {

// Returns the material, without its texture. The one that Assimp adds to meshes without one becomes NFF's
// default, white and matte.
Material to_material(const aiMaterial& from);

// Returns the path of the picture that colours a material as its file has it, or "*N" for the N-th within the
// file; empty without.
std::string picture_path(const aiMaterial& from);

// Returns a material for a file. Phong's model is that of NFF without the mirror. Formats with only
// physically based materials get smooth metal for it. `picture`: as picture_path() returns it.
std::unique_ptr<aiMaterial> to_assimp(const Material& material, const std::string& name,
                                      bool physically_based, const std::string& picture);

}  // namespace pprt
