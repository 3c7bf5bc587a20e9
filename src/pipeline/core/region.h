// The set of tiles that one rank samples and reconstructs (paper s. 3.3).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/circle.h"
#include "pipeline/core/tile_grid.h"

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
  PixelRect bounds_with(std::span<const std::int32_t> further_tiles) const;
  std::size_t pixel_count() const { return pixel_count_; }
  bool is_whole() const { return tiles_.size() == owned_.size(); }  // there is no other region

  // Whether the part of a circle inside the image certainly lies in the region. May return false for a circle
  // that does.
  bool surely_holds(const Circle& circle) const {
    const Vec2d& c = circle.center;
    if (!(c.x >= 0 && c.y >= 0 && c.x <= grid_.width && c.y <= grid_.height)) return false;
    const int column = grid_.column_at(c.x), row = grid_.row_at(c.y);
    const int tile = column + row * grid_.columns();
    if (!owns_tile(tile)) return false;
    const double beyond_tile = inside_by_[static_cast<std::size_t>(tile)];
    if (circle.radius_squared < beyond_tile * beyond_tile) return true;
    const PixelSpan x = grid_.column(column), y = grid_.row(row);
    const double to_side = std::min({c.x - x.begin, x.end - c.x, c.y - y.begin, y.end - c.y});
    const double inside_by = beyond_tile + std::max(to_side, 0.0);
    return circle.radius_squared < inside_by * inside_by;
  }

 private:
  TileGrid grid_;
  std::vector<std::uint8_t> owned_;
  std::vector<int> tiles_;
  std::vector<double> inside_by_;  // per tile: lower bound of its distance from any other region, pixels
  PixelRect bounds_;
  std::size_t pixel_count_ = 0;
};

}  // namespace pprt
