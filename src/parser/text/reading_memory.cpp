#include "parser/text/reading_memory.h"

#include <fmt/format.h>

#include "base/system/available_memory.h"

namespace pprt {

std::uint64_t usual_reading_memory() {
  return available_memory() / 8;
}

std::uint64_t memory_of(const SceneDescription& scene) {
  std::uint64_t bytes = 0;
  const auto add = [&bytes](const auto&... lists) { ((bytes += lists.size() * sizeof(lists[0])), ...); };
  add(scene.order, scene.nodes, scene.spheres, scene.cones, scene.polygons, scene.polygon_vertices,
      scene.patches, scene.patch_vertices, scene.triangles, scene.meshes, scene.moving_triangles,
      scene.materials, scene.lights, scene.light_nodes, scene.movement.nodes);
  for (const TriangleMesh& mesh : scene.meshes) add(mesh.positions, mesh.normals, mesh.texture_points);
  for (const MovingTriangle& triangle : scene.moving_triangles) add(triangle.keys);
  for (const Texture& texture : scene.textures) add(texture.rgb);
  return bytes;
}

std::string too_much_memory(std::uint64_t most) {
  return fmt::format(
      "the scene takes more than {:.4g} MB of memory, the most that reading may take (--memory)",
      static_cast<double>(most) * 1e-6);
}

}  // namespace pprt
