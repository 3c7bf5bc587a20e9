// What lights bring to the nodes of the lattice where nothing hides them. It is known without a ray, so a
// sample tells of all its surface which lights are seen (docs/decisions/0037-lights.md).
#pragma once

#include <cstdint>
#include <utility>

#include "base/unshadowed_light.h"
#include "pipeline/lattice/lattice_node.h"
#include "pipeline/lattice/node_cache.h"
#include "pipeline/visibility/visibility_buffer.h"

namespace pprt {

// The reference must outlive the object. All is asked only if the visibility is known.
class SurfaceLights {
 public:
  SurfaceLights(PrimitiveLights lights, VisibilityBuffer& visibility)
      : lights_(std::move(lights)), visibility_(visibility) {}

  // What is seen is forgotten.
  void forget() { kept_.clear(); }

  // What is known of a surface.
  LitSurface of(std::uint32_t surface) const {
    return surface < lights_.surfaces.size() ? lights_.surfaces[surface] : LitSurface{};
  }

  // Whether the light changes on it from point to point.
  bool is_curved(std::uint32_t surface) const {
    const LitShape shape = of(surface).shape;
    return shape == LitShape::kRound || shape == LitShape::kSmooth;
  }

  // Returns the light on a surface at a node, or on a primitive at an image point, until the next call.
  const UnshadowedLight& at(const LatticeNode& node, std::uint32_t surface);
  const UnshadowedLight& at(const Vec2d& point, std::uint32_t primitive);

  // The same into `light`.
  void at(const Vec2d& point, std::uint32_t primitive, UnshadowedLight& light) const {
    lights_.at(primitive, point.x, point.y, light);
  }

  // Returns the part of a node's colour that the lights bring that it sees.
  float4 part_of(const NodeValue& value, const LatticeNode& node);

  // Returns a node's colour where its surface is lit like this.
  float4 moved(const NodeValue& value, const LatticeNode& node, const UnshadowedLight& to) {
    const float4 own = value.channels() - part_of(value, node), there = own + to.of(value.lights());
    return there > 0 ? there : float4{};
  }

 private:
  std::uint32_t primitive_at(const LatticeNode& node, std::uint32_t surface);

  PrimitiveLights lights_;
  VisibilityBuffer& visibility_;
  UnshadowedLight light_, of_node_;
  NodeCache<float4> kept_;  // by surface and lights seen
};

}  // namespace pprt
