#include "parallel/rank/picture_refresh.h"

#include <algorithm>

namespace pprt {

void PictureRefresh::reconstruct(Sampler& sampler, std::span<const std::int32_t> further_tiles) {
  sampler.paint(further_tiles, pixels_);
  const Region& region = sampler.region();
  tiles_.assign(region.tiles().begin(), region.tiles().end());
  shows_.assign(static_cast<std::size_t>(region.grid().tile_count()), sampler.size());
}

double PictureRefresh::refresh(Sampler& sampler, const std::function<bool()>& is_over) {
  const Region& region = sampler.region();
  const bool is_same =
      tiles_.size() == region.tiles().size() && pixels_.bounds == region.bounds() &&
      std::all_of(tiles_.begin(), tiles_.end(), [&](int tile) { return region.owns_tile(tile); });
  if (!is_same) {
    reconstruct(sampler, {});
    return 1;
  }
  if (tiles_.empty()) return 1;
  const auto shows = [this](std::int32_t tile) -> std::size_t& {
    return shows_[static_cast<std::size_t>(tile)];
  };
  const auto waiting = std::find_if(tiles_.begin(), tiles_.end(),
                                    [&](std::int32_t tile) { return shows(tile) == sampler.size(); });
  if (waiting == tiles_.begin() || is_over()) return 0;
  const std::span<const std::int32_t> stale(tiles_.begin(), waiting);
  const std::size_t done = sampler.repaint(stale, is_over, pixels_);
  for (const std::int32_t tile : stale.first(done)) shows(tile) = sampler.size();
  std::rotate(tiles_.begin(), tiles_.begin() + static_cast<std::ptrdiff_t>(done), tiles_.end());
  return static_cast<double>(done) / static_cast<double>(tiles_.size());
}

void PictureRefresh::append_tile(const TileGrid& grid, int tile, std::vector<Color>& colors) const {
  const PixelRect rect = grid.pixels(tile);
  for (int y = rect.y0; y < rect.y1; ++y) {
    const Color* row = &pixels_.at(rect.x0, y);
    colors.insert(colors.end(), row, row + rect.width());
  }
}

}  // namespace pprt
