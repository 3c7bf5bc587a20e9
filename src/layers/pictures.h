// Draws layers as pictures to look at. Colours are display values.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/first_hit.h"
#include "image/image.h"
#include "layers/coverage_mask.h"
#include "layers/triangulation.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

// Returns the whole factor by which drawings are larger than the frame. Their longer side has at least 1024
// pixels, so that single samples can be told apart.
int drawing_scale(int width, int height);

// Returns the image with a square of `scale` pixels a side for each pixel.
Image enlarged(const Image& image, int scale);

// Draw a dot per sample (paper fig. 1c), and the triangles' edges (fig. 1d), at that scale.
CoverageMask sample_dots(const Triangulation& frame);
CoverageMask triangle_edges(const Triangulation& frame);
Image black_on_white(const CoverageMask& mask);

// Draws the frame in grey, tinted by owner, and the borders between regions (fig. 2e, 4b). `owners` has a
// rank per tile; negative: no rank, and no tint.
Image region_picture(const Image& frame, const TileGrid& grid, std::span<const std::int32_t> owners);

// Writes the number of each rank into its region, in a picture of any size of region_picture().
void label_ranks(Image& picture, const TileGrid& grid, std::span<const std::int32_t> owners);

// Draws a measure from `low` (dark) to `high` (light), both positive. Equal factors make equal steps.
Image heat_picture(std::span<const float> values, int width, int height, double low, double high);

// Draws the complexity map (fig. 1b): white is one ray, black kMostRays or more.
inline constexpr double kMostRays = 64;
Image cost_picture(std::span<const float> values, int width, int height);

// Draws depth: near is light, misses are black. Steps are equal in 1 / depth, between the frame's nearest and
// farthest point.
Image depth_picture(std::span<const FirstHit> hits, int width, int height);

// Draws normals: components -1 to 1 become channels 0 to 1. Misses are black.
Image normal_picture(std::span<const FirstHit> hits, int width, int height);

// Draws ids: a hue per material, a lightness per primitive. Misses are black.
Image id_picture(std::span<const FirstHit> hits, int width, int height);

}  // namespace pprt
