// What one eye ray found: all that the image's refinement and the next frame need to know of it.
#pragma once

#include <cstdint>

#include "base/vector.h"

namespace pprt {

struct RaySample {
  Color color{0, 0, 0};         // linear, not clamped
  Vec3f hit{0, 0, 0};           // first hit point in the compiled scene's space; a miss: unit direction
  bool at_infinity = false;     // a miss: `hit` is a direction
  bool eye_dependent = false;   // colour holds highlights, reflection or refraction: stale when the eye moves
  std::uint32_t primitive = 0;  // that of the first hit, by its place in the scene from 1; a miss: 0
  std::uint32_t rays = 1;       // rays of all kinds in the tree, the work it took
};

}  // namespace pprt
