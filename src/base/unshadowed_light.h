// What is known of a surface's colour at a place without a ray: what each light brings where nothing hides
// it.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "base/ray_sample.h"
#include "base/simd.h"

namespace pprt {

// How primitives are lit.
enum class LitShape : std::uint8_t {
  kNone,    // lights bring nothing, or it is not known what
  kFlat,    // a facet: what they bring changes little from point to point
  kSmooth,  // a facet with interpolated normals
  kRound    // a sphere or a cone
};

// What is known of a primitive's light.
struct LitSurface {
  LitShape shape = LitShape::kNone;
  bool is_all = false;  // nothing else is seen of it but its own colour
};

// Colours are linear; the last lane does not count.
struct UnshadowedLight {
  bool is_known = false;
  int count = 0;                          // of the lights told apart
  float4 unlit{};                         // the surface's own colour
  std::array<float4, kNotedLights> each;  // the first `count` of them

  // Returns the sum of the lights seen, a bit each.
  float4 of(std::uint8_t seen) const {
    float4 sum{};
    for (int i = 0; i < count; ++i) {
      const int4 is_seen = int4{} - (seen >> i & 1);
      sum += std::bit_cast<float4>(std::bit_cast<int4>(each[static_cast<std::size_t>(i)]) & is_seen);
    }
    return sum;
  }
};

// The same of all primitives in the image.
struct PrimitiveLights {
  // By primitive number, 0 included. Empty: nothing is known of any.
  std::span<const LitSurface> surfaces = {};
  // Replaces `light` by that of a primitive where the eye ray through an image point, pixels, meets it. Where
  // it passes beside, a point of the primitive near it counts.
  std::function<void(std::uint32_t primitive, double x, double y, UnshadowedLight& light)> at = {};
};

// Returns the lights that a sample sees, a bit each. One that its surface is turned away from may be seen
// where the surface turns to it.
inline std::uint8_t seen_from(const SeenLights& lights) {
  return static_cast<std::uint8_t>(lights.seen | ~lights.asked);
}

}  // namespace pprt
