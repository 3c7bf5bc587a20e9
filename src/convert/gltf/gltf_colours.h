// Colours at the vertices of a mesh, as a texture.
#pragma once

#include <optional>

#include "convert/gltf/gltf_model.h"
#include "convert/model/model_builder.h"
#include "scene/description/texture.h"

namespace pprt {

// Gives each triangle of a mesh corners of its own, and texture coordinates in a picture of the colours,
// which are linear. Colours between corners are those of straight courses of display values; at the edge
// between colours that are as bright as can be they stray by a twelfth of the range. Empty for more than 2
// million triangles, or without colours for all corners.
std::optional<Texture> paint(ModelMesh& mesh, const GltfNumbers& colors);

}  // namespace pprt
