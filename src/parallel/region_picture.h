// The pixels of one rank's region (paper s. 2.2, 3.7).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/probe.h"
#include "pipeline/reconstruction/reconstruction.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

class RegionPicture {
 public:
  RegionPicture(const Probe& probe, PixelRule rule)
      : rule_(rule), knows_shapes_(probe.project), projected_shapes_(probe.project) {}

  // The probe looks from another camera: projected shapes are no longer right.
  void camera_changed() { projected_shapes_.forget(); }

  // Reconstructs the region's pixels, and those of further tiles that the mesh covers.
  void reconstruct_region(const SampleMesh& mesh, std::span<const std::int32_t> further_tiles);

  // Appends the pixels of a tile to `rgb`: rows from the top, 3 values a pixel.
  void append_tile(const TileGrid& grid, int tile, std::vector<float>& rgb) const;

 private:
  PixelRule rule_;
  bool knows_shapes_;
  RegionPixels pixels_;
  ReconstructionBuffers buffers_;
  ProjectedShapeCache projected_shapes_;
};

}  // namespace pprt
