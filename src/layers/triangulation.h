// All samples of a frame, of all ranks, and their Delaunay triangulation as plain values.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/sample.h"
#include "pipeline/core/tile_grid.h"
#include "pipeline/mesh/reconstruction.h"

namespace pprt {

struct Triangulation {
  int width = 0;  // of the frame, pixels
  int height = 0;
  std::vector<Sample> samples;                          // no two at one point
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into samples
  std::vector<std::uint32_t> triangle_at;               // per pixel: that holds its centre, or kNoTriangle
};

// Triangulates the union of all ranks' samples. Their order does not matter.
Triangulation triangulate_frame(std::vector<Sample> samples, const TileGrid& grid);

// Interpolates a value per sample linearly over each triangle. Returns it at pixel centres, 0 where no
// triangle is.
std::vector<float> interpolate(const Triangulation& frame, std::span<const float> at_samples);

}  // namespace pprt
