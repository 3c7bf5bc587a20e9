#include "pipeline/region.h"

#include <algorithm>
#include <utility>

namespace pprt {

Region::Region(const TileGrid& grid, std::vector<std::uint8_t> owned)
    : grid_(grid), owned_(std::move(owned)) {
  owned_.resize(static_cast<std::size_t>(grid.tile_count()), 0);
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    if (!owns_tile(tile)) continue;
    const PixelRect rect = grid.pixels(tile);
    if (tiles_.empty()) bounds_ = rect;
    bounds_.x0 = std::min(bounds_.x0, rect.x0);
    bounds_.y0 = std::min(bounds_.y0, rect.y0);
    bounds_.x1 = std::max(bounds_.x1, rect.x1);
    bounds_.y1 = std::max(bounds_.y1, rect.y1);
    tiles_.push_back(tile);
    pixel_count_ += rect.area();
  }
}

Region Region::whole(const TileGrid& grid) {
  return Region(grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.tile_count()), 1));
}

}  // namespace pprt
