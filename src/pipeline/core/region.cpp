#include "pipeline/core/region.h"

#include <algorithm>
#include <utility>

namespace pprt {
namespace {

// Returns per tile the number of tiles between it and the nearest that is not owned, in rows, columns or
// diagonals; -1 for a tile that is not owned. Two sweeps over the grid: each takes the minimum over the
// neighbours that it has passed.
std::vector<int> tiles_between(const TileGrid& grid, const std::vector<std::uint8_t>& owned) {
  const int columns = grid.columns(), rows = grid.rows();
  std::vector<int> between(owned.size());
  const auto index = [columns](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x);
  };
  for (std::size_t tile = 0; tile < owned.size(); ++tile)
    between[tile] = owned[tile] != 0 ? std::max(columns, rows) : -1;
  const auto take_over = [&](int x, int y, int dx, int dy) {
    if (x + dx < 0 || x + dx >= columns || y + dy < 0 || y + dy >= rows) return;
    int& here = between[index(x, y)];
    here = std::min(here, between[index(x + dx, y + dy)] + 1);
  };
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      take_over(x, y, -1, 0), take_over(x, y, -1, -1), take_over(x, y, 0, -1), take_over(x, y, 1, -1);
    }
  }
  for (int y = rows - 1; y >= 0; --y) {
    for (int x = columns - 1; x >= 0; --x) {
      take_over(x, y, 1, 0), take_over(x, y, 1, 1), take_over(x, y, 0, 1), take_over(x, y, -1, 1);
    }
  }
  return between;
}

PixelRect united(const PixelRect& a, const PixelRect& b) {
  if (a.area() == 0) return b;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

Region::Region(const TileGrid& grid, std::vector<std::uint8_t> owned)
    : grid_(grid), owned_(std::move(owned)) {
  owned_.resize(static_cast<std::size_t>(grid.tile_count()), 0);
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    if (!owns_tile(tile)) continue;
    const PixelRect rect = grid.pixels(tile);
    bounds_ = united(bounds_, rect);
    tiles_.push_back(tile);
    pixel_count_ += rect.area();
  }
  inside_by_.reserve(owned_.size());
  for (const int between : tiles_between(grid, owned_))
    inside_by_.push_back(std::max(between, 0) * grid.tile_size);
}

PixelRect Region::bounds_with(std::span<const std::int32_t> further_tiles) const {
  PixelRect bounds = bounds_;
  for (const int tile : further_tiles) bounds = united(bounds, grid_.pixels(tile));
  return bounds;
}

Region Region::whole(const TileGrid& grid) {
  return Region(grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.tile_count()), 1));
}

}  // namespace pprt
