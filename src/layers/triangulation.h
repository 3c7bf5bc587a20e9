// All samples of a frame and their Delaunay triangulation, as plain values, whoever traced them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/reconstruction/reconstruction.h"
#include "pipeline/sample.h"
#include "pipeline/tile_grid.h"

namespace pprt {

struct Triangulation {
  int width = 0;  // of the frame, pixels
  int height = 0;
  std::vector<Sample> samples;                          // no two in one place
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into samples
  std::vector<std::uint32_t> triangle_at;               // per pixel: holds its centre; kNoTriangle: none does
};

// Of the union of all ranks' samples, in whatever order they came.
Triangulation triangulate_frame(std::vector<Sample> samples, const TileGrid& grid);

// A value per sample as a value per pixel: linear over each triangle, at pixel centres; 0 where no triangle
// is.
std::vector<float> interpolate(const Triangulation& frame, std::span<const float> at_samples);

}  // namespace pprt
