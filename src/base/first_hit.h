// What an eye ray meets first, without its colour: what pictures of a scene's shape are made of.
#pragma once

#include <cstdint>
#include <limits>

#include "base/vector.h"

namespace pprt {

struct FirstHit {
  float depth = std::numeric_limits<float>::infinity();  // along the direction of view, scene units
  Vec3f normal{0, 0, 0};        // unit, in the scene's axes, towards the eye; a miss: zero
  std::uint32_t primitive = 0;  // of the scene, counted from 1; a miss: 0
  std::uint32_t material = 0;   // likewise
};

}  // namespace pprt
