// Reading glTF.
#pragma once

#include <cstdint>
#include <string>

#include "convert/gltf/gltf_document.h"
#include "convert/gltf/gltf_model.h"
#include "convert/model/read_mesh.h"

namespace pprt {

// Reads a file of glTF 2.0. `bytes`: the file's. `facts`: of them. `animation`: the name of the one to be
// shown; empty: the first. Throws InputError.
//
// Colours and lights become display values. The brightest light gets the intensity 1 in the middle of the
// scene, the others theirs by comparison, and the ambient light is 1.
ReadMesh read_gltf(const std::string& path, std::string bytes, const GltfFacts& facts,
                   const std::string& animation, std::uint64_t max_memory, GltfFiles& files);

}  // namespace pprt
