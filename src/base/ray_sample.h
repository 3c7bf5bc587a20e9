// The result of one eye ray: all that refinement and the next frame need of it.
#pragma once

#include <cstdint>

#include "base/vector.h"

namespace pprt {

inline constexpr int kNotedLights = 8;  // of a scene, the first ones

// Which of the noted lights a point sees: bit i is light i.
struct SeenLights {
  std::uint8_t asked = 0;  // the lights before the surface, for which a shadow ray told
  std::uint8_t seen = 0;   // of those, the ones that nothing hides
};

// What is known of the light at a primitive, near the point where an eye ray may hit it.
struct KnownLights {
  std::uint32_t primitive = 0;  // as RaySample's
  SeenLights lights;
  std::int32_t frame = 0;  // in which the shadow rays were sent
};

// Colour and first hit of one eye ray.
struct RaySample {
  Color color{0, 0, 0};      // linear, not clamped
  Vec3f hit{0, 0, 0};        // first hit point in the compiled scene's space; a miss: unit direction
  bool at_infinity = false;  // the ray missed: `hit` is a direction
  bool eye_dependent =
      false;  // the colour holds highlights, reflection or refraction, so it is stale when the eye moves
  SeenLights lights;            // at the first hit
  std::uint32_t primitive = 0;  // number of the first hit's primitive in the scene, from 1; a miss: 0
  std::uint32_t rays = 1;       // rays of all kinds in its ray tree: the work it took
};

// What has become of a sample when things have moved.
enum class Carried : std::uint8_t {
  kKept,    // it is where its object is now
  kRelit,   // and something that moved may have changed the light there: its colour is of another time
  kNothing  // its point is no more: it is hidden with its object, or the object has changed its shape
};

}  // namespace pprt
