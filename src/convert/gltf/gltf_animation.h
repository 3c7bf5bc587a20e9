// Movement of glTF: jumps (STEP), straight lines (LINEAR) and curves (CUBICSPLINE).
#pragma once

#include <string>
#include <vector>

#include "convert/gltf/gltf_model.h"
#include "convert/model/model_animation.h"
#include "convert/model/model_losses.h"

namespace pprt {

// Returns one of a file's animations; without a name the first. Tracks have the names of `tracks`, one for
// each node.
//
// Curves become as many straight lines as keep within 1/4,000 of a movement's extent and 0.02 degrees.
// Throws std::runtime_error for keys out of range, and where there is no animation of that name.
ModelAnimation gltf_animation(const tinygltf::Model& model, const GltfFacts& facts, const std::string& name,
                              const std::vector<std::string>& tracks, ModelLosses& losses);

// The parts of a node's own transform, where it has them.
TrackValues gltf_placement(const tinygltf::Node& node);

}  // namespace pprt
