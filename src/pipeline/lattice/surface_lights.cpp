#include "pipeline/lattice/surface_lights.h"

namespace pprt {

// Surfaces of several primitives are told by one of them.
std::uint32_t SurfaceLights::primitive_at(const LatticeNode& node, std::uint32_t surface) {
  if (of(surface).shape == LitShape::kRound) return surface;
  const std::uint32_t there = visibility_.primitive_at(point_of(node), surface);
  return there != 0 ? there : surface;
}

const UnshadowedLight& SurfaceLights::at(const LatticeNode& node, std::uint32_t surface) {
  return at(point_of(node), primitive_at(node, surface));
}

const UnshadowedLight& SurfaceLights::at(const Vec2d& point, std::uint32_t primitive) {
  lights_.at(primitive, point.x, point.y, light_);
  return light_;
}

float4 SurfaceLights::part_of(const NodeValue& value, const LatticeNode& node) {
  return kept_.get(node, value.surface_and_lights(), [&] {
    const Vec2d point = point_of(node);
    lights_.at(primitive_at(node, value.surface()), point.x, point.y, of_node_);
    return of_node_.is_known ? of_node_.of(value.lights()) : float4{};
  });
}

}  // namespace pprt
