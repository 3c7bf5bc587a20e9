// The set of tiles that one rank samples and reconstructs (paper s. 3.3).
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/tile_grid.h"

namespace pprt {

class Region {
 public:
  // `owned` has an entry per tile: non-zero where the tile belongs to the region.
  Region(const TileGrid& grid, std::vector<std::uint8_t> owned);

  // The whole image.
  static Region whole(const TileGrid& grid);

  const TileGrid& grid() const { return grid_; }
  bool owns_tile(int tile) const { return owned_[static_cast<std::size_t>(tile)] != 0; }
  bool owns_point(double x, double y) const { return owns_tile(grid_.tile_at(x, y)); }
  const std::vector<int>& tiles() const { return tiles_; }  // ascending
  const PixelRect& bounds() const { return bounds_; }       // smallest rectangle that holds every owned pixel
  std::size_t pixel_count() const { return pixel_count_; }

 private:
  TileGrid grid_;
  std::vector<std::uint8_t> owned_;
  std::vector<int> tiles_;
  PixelRect bounds_;
  std::size_t pixel_count_ = 0;
};

}  // namespace pprt
