// The first hit of an eye ray, without its colour. Depth, normal and object pictures are made of these.
#pragma once

#include <cstdint>
#include <limits>

#include "base/vector.h"

namespace pprt {

// The defaults describe a miss.
struct FirstHit {
  float depth = std::numeric_limits<float>::infinity();  // distance along the direction of view, scene units;
                                                         // a miss: infinite
  Vec3f normal{0, 0, 0};                                 // unit, in scene axes, towards the eye; a miss: zero
  std::uint32_t primitive = 0;                           // its number in the scene, from 1; a miss: 0
  std::uint32_t material = 0;                            // its number in the scene, from 1; a miss: 0
};

}  // namespace pprt
