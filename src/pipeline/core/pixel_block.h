// Pixels of a part of the picture, and the rule by which samples become pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

// The pixels of a rectangle, row by row from the top.
struct PixelBlock {
  PixelRect bounds;
  std::vector<Color> colors;

  const Color& at(int x, int y) const {
    return colors[static_cast<std::size_t>(y - bounds.y0) * static_cast<std::size_t>(bounds.width()) +
                  static_cast<std::size_t>(x - bounds.x0)];
  }
};

// What a pixel that holds several samples shows. All other pixels show the interpolation at their centre,
// except under kEdges.
enum class PixelRule : std::uint8_t {
  kCenter,  // the interpolation at its centre as well
  kMean,    // the samples' mean: the paper's rule
  kArea,    // the interpolation's mean over the pixel's area
  kEdges    // as kArea, and a triangle with corners on different primitives shows each where it is seen
};

}  // namespace pprt
