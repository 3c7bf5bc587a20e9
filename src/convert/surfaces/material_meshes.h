// A scene's surfaces as triangles, sorted by material.
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "convert/surfaces/tessellate.h"
#include "scene/description/scene_description.h"

namespace pprt {

// The triangles of one material in one node, with vertices of their own.
struct MaterialMesh {
  std::vector<PatchVertex> vertices;
  std::vector<Vec2d> texture_points;  // of all vertices, or of none
  std::vector<TriangleIndices> triangles;
};

using MaterialMeshes = std::map<std::pair<NodeIndex, MaterialIndex>, MaterialMesh>;

// Returns all triangles, in their nodes' spaces. Flat surfaces have their own normal at every vertex, so that
// they stay flat. `degenerate` becomes the number of primitives of no extent. No triangle may change its
// shape (still_at()).
MaterialMeshes material_meshes(const SceneDescription& scene, const Fineness& fineness,
                               std::size_t& degenerate);

}  // namespace pprt
