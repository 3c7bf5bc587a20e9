// Meshes of glTF.
#pragma once

#include "convert/gltf/gltf_materials.h"
#include "convert/gltf/gltf_model.h"
#include "convert/model/model_builder.h"
#include "convert/model/model_losses.h"

namespace pprt {

// Adds the triangles of a part of a mesh, with its material. Throws std::runtime_error for numbers that are
// not there.
void add_gltf_primitive(const tinygltf::Model& model, const tinygltf::Primitive& from,
                        GltfMaterials& materials, ModelLosses& losses, ModelBuilder& builder,
                        const ModelSpace& space);

// Whether a mesh has a material of one side and an edge beyond which its faces are seen from behind. Throws
// std::runtime_error for numbers that are not there.
bool is_open_behind(const tinygltf::Model& model, const tinygltf::Mesh& from, GltfMaterials& materials);

}  // namespace pprt
