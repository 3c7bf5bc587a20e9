// Lights of glTF (KHR_lights_punctual).
#pragma once

#include <vector>

#include "convert/gltf/gltf_model.h"
#include "convert/model/model_builder.h"
#include "convert/model/model_losses.h"

namespace pprt {

struct PlacedGltfLight {
  int light = 0;  // its place among the file's
  ModelSpace space;
};

// Adds lights to a scene that has its meshes. Their intensities are those in the middle of the scene at the
// animation's start, as display values; the brightest is 1.
void add_gltf_lights(const tinygltf::Model& model, const std::vector<PlacedGltfLight>& placed,
                     ModelLosses& losses, ModelBuilder& builder);

}  // namespace pprt
