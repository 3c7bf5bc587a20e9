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
  const auto hash =
      static_cast<std::uint32_t>(node.x) * 0x9E3779B1U + static_cast<std::uint32_t>(node.y) * 0x85EBCA77U;
  Kept& kept = kept_[hash >> 20];
  static_assert(kKept == std::size_t{1} << 12);
  if (kept.node == node && kept.surface == value.surface() && kept.seen == value.lights()) return kept.part;
  const Vec2d point = point_of(node);
  lights_.at(primitive_at(node, value.surface()), point.x, point.y, of_node_);
  kept = {node, value.surface(), value.lights(), of_node_.is_known ? of_node_.of(value.lights()) : float4{}};
  return kept.part;
}

}  // namespace pprt
