// A frame small enough to be computed by hand.
#pragma once

#include <vector>

#include "layers/triangulation.h"

namespace pprt::test {

inline Sample sample(double x, double y, int frame = 1, std::uint32_t rays = 1,
                     const Color& color = Color(0)) {
  Sample s;
  s.x = x, s.y = y;
  s.frame = frame;
  s.ray.rays = rays;
  s.ray.color = color;
  s.id = static_cast<SampleId>(100 * y + x);
  return s;
}

inline const TileGrid kFourByFour{4, 4, 2};

// Four corners of 4 x 4 pixels and the middle: four triangles of area 4, one a side.
inline std::vector<Sample> corners_and_middle() {
  return {sample(0, 0), sample(4, 0, 1, 3), sample(0, 4), sample(4, 4, 1, 3),
          sample(2, 2, 3, 11, Color(1, 0, 0))};
}

}  // namespace pprt::test
