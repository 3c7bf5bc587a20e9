// Colours at the vertices of a mesh, as a texture.
#pragma once

#include <optional>
#include <vector>

#include "convert/model/model_builder.h"
#include "scene/description/texture.h"

namespace pprt {

// Cuts the faces of a mesh into triangles with corners of their own, and gives them texture coordinates in a
// picture of the vertices' colours, which are display values. Colours between corners are those of straight
// courses; at the edge between colours that are as bright as can be they stray by a twelfth of the range.
// Empty for more than 2 million triangles, or without colours for all corners.
std::optional<Texture> paint(ModelMesh& mesh, const std::vector<Rgb>& colors);

}  // namespace pprt
