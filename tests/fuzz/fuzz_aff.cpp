// libFuzzer entry. Any bytes must be an InputError, or a scene whose indices are in range and that is finite
// at every time.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "base/diagnostics.h"
#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const pprt::SceneDescription& scene) {
  const auto& nodes = scene.movement.nodes;
  for (std::size_t i = 1; i < nodes.size(); ++i) require(nodes[i].parent < i);
  require(scene.nodes.size() == scene.order.size() && scene.light_nodes.size() == scene.lights.size());
  for (std::size_t i = 0; i < scene.order.size(); ++i) {
    require(pprt::material_of(scene, scene.order[i]) < scene.materials.size() &&
            scene.nodes[i] < nodes.size());
  }
  for (const pprt::Material& m : scene.materials) require(!m.texture || *m.texture < scene.textures.size());
  for (const auto& [number, t] : scene.triangles) {
    const pprt::TriangleMesh& mesh = scene.meshes[number];
    for (std::size_t i = 0; i < 3; ++i) {
      require(t.position[i] < mesh.positions.size());
      require(mesh.normals.empty() || t.normal[i] < mesh.normals.size());
      require(mesh.texture_points.empty() || t.texture_point[i] < mesh.texture_points.size());
    }
  }
  for (const double time : {-1e100, 0.0, 0.5, 1.0, 2.5, 1e100}) {
    pprt::placements_at(scene.movement, time);
    for (const auto& [name, track] : scene.movement.tracks) {
      const pprt::Affine map = pprt::placement_at(track, time).to_parent;
      require(!std::isnan(map.origin.x + map.origin.y + map.origin.z));
    }
    for (const pprt::MovingTriangle& triangle : scene.moving_triangles) {
      pprt::shape_at(triangle, time);
    }
    pprt::view_at(scene, time);
    require(pprt::still_at(scene, time).nodes.size() <= scene.order.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    pprt::AffOptions options;
    options.strict = (data[0] & 1) != 0;
    check(pprt::parse_aff(text, "fuzz.aff", options).scene);
  } catch (const pprt::InputError&) {
  }
  return 0;
}
