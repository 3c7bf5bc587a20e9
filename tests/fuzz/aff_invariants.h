// What must hold of every scene that the reader of AFF returns.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "scene/animation/resting_nodes.h"
#include "scene/description/scene_description.h"

namespace pprt::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void require_indices_in_range(const SceneDescription& scene) {
  const auto& nodes = scene.movement.nodes;
  for (std::size_t i = 1; i < nodes.size(); ++i) require(nodes[i].parent < i);
  require(scene.nodes.size() == scene.order.size() && scene.light_nodes.size() == scene.lights.size());
  for (std::size_t i = 0; i < scene.order.size(); ++i) {
    require(material_of(scene, scene.order[i]) < scene.materials.size() && scene.nodes[i] < nodes.size());
  }
  for (const Material& m : scene.materials) {
    for (const auto& texture : {m.texture, m.emission_texture})
      require(!texture || *texture < scene.textures.size());
  }
  for (const auto& [number, t] : scene.triangles) {
    const TriangleMesh& mesh = scene.meshes[number];
    for (std::size_t i = 0; i < 3; ++i) {
      require(t.position[i] < mesh.positions.size());
      require(mesh.normals.empty() || t.normal[i] < mesh.normals.size());
      require(mesh.texture_points.empty() || t.texture_point[i] < mesh.texture_points.size());
    }
  }
}

inline void require_finite_at_all_times(const SceneDescription& scene) {
  for (const double time : {-1e100, 0.0, 0.5, 1.0, 2.5, 1e100}) {
    placements_at(scene.movement, time);
    for (const auto& [name, track] : scene.movement.tracks) {
      const Affine map = placement_at(track, time).to_parent;
      require(!std::isnan(map.origin.x + map.origin.y + map.origin.z));
    }
    for (const MovingTriangle& triangle : scene.moving_triangles) shape_at(triangle, time);
    view_at(scene, time);
    require(still_at(scene, time).nodes.size() <= scene.order.size());
  }
}

}  // namespace pprt::fuzz
