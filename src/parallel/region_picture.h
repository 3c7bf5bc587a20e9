// The pixels of one rank's region (paper s. 2.2, 3.7).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/region_samples.h"

namespace pprt {

class RegionPicture {
 public:
  // Reconstructs the region's pixels, and those of further tiles that the samples cover.
  void reconstruct(RegionSamples& samples, std::span<const std::int32_t> further_tiles) {
    samples.paint(further_tiles, pixels_);
  }

  // Appends the pixels of a tile to `colors`, rows from the top.
  void append_tile(const TileGrid& grid, int tile, std::vector<Color>& colors) const;

  const RegionPixels& pixels() const { return pixels_; }

 private:
  RegionPixels pixels_;
};

}  // namespace pprt
