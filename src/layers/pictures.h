// Each layer as a picture for people. Colours are display values.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/first_hit.h"
#include "image/image.h"
#include "layers/coverage_mask.h"
#include "layers/triangulation.h"
#include "pipeline/tile_grid.h"

namespace pprt {

// Drawings are larger than the frame by this whole factor, so that the longer side has at least 1024 pixels
// and single samples can be told apart.
int drawing_scale(int width, int height);

// Black dots on white (paper fig. 1c).
CoverageMask sample_dots(const Triangulation& frame);
// The edges (fig. 1d).
CoverageMask triangle_edges(const Triangulation& frame);
Image black_on_white(const CoverageMask& coverage);

// The frame, tinted by owner, with the borders between regions drawn over it (fig. 2e, 4b). `owners` per
// tile; negative: nobody's, which stays as it is.
Image region_picture(const Image& frame, const TileGrid& grid, std::span<const std::int32_t> owners);

// A measure from its `low` (dark) to its `high` (light), equal steps for equal factors. Both positive.
Image heat_picture(std::span<const float> values, int width, int height, double low, double high);

// The complexity map: darker is dearer (fig. 1b), white is one ray, black kMostRays or more.
inline constexpr double kMostRays = 64;
Image cost_picture(std::span<const float> values, int width, int height);

// Near is light; equal steps for equal differences of 1 / depth between the frame's nearest and farthest
// point. Misses are black.
Image depth_picture(std::span<const FirstHit> hits, int width, int height);

// Components -1 to 1 as colour 0 to 1; misses are black.
Image normal_picture(std::span<const FirstHit> hits, int width, int height);

// A hue for each material, a lightness for each primitive; misses are black.
Image id_picture(std::span<const FirstHit> hits, int width, int height);

}  // namespace pprt
