#include "parallel/region_picture.h"

#include <algorithm>

namespace pprt {

void RegionPicture::reconstruct(RegionSamples& samples, std::span<const std::int32_t> further_tiles) {
  samples.paint(further_tiles, pixels_);
  const Region& region = samples.region();
  tiles_.assign(region.tiles().begin(), region.tiles().end());
  shows_.assign(static_cast<std::size_t>(region.grid().tile_count()), samples.size());
}

double RegionPicture::refresh(RegionSamples& samples, const std::function<bool()>& is_over) {
  const Region& region = samples.region();
  const bool is_same =
      tiles_.size() == region.tiles().size() && pixels_.bounds == region.bounds() &&
      std::all_of(tiles_.begin(), tiles_.end(), [&](int tile) { return region.owns_tile(tile); });
  if (!is_same) {
    reconstruct(samples, {});
    return 1;
  }
  if (tiles_.empty()) return 1;
  const auto shows = [this](std::int32_t tile) -> std::size_t& {
    return shows_[static_cast<std::size_t>(tile)];
  };
  const auto waiting = std::find_if(tiles_.begin(), tiles_.end(),
                                    [&](std::int32_t tile) { return shows(tile) == samples.size(); });
  if (waiting == tiles_.begin() || is_over()) return 0;
  const std::span<const std::int32_t> stale(tiles_.begin(), waiting);
  const std::size_t done = samples.repaint(stale, is_over, pixels_);
  for (const std::int32_t tile : stale.first(done)) shows(tile) = samples.size();
  std::rotate(tiles_.begin(), tiles_.begin() + static_cast<std::ptrdiff_t>(done), tiles_.end());
  return static_cast<double>(done) / static_cast<double>(tiles_.size());
}

void RegionPicture::append_tile(const TileGrid& grid, int tile, std::vector<Color>& colors) const {
  const PixelRect rect = grid.pixels(tile);
  for (int y = rect.y0; y < rect.y1; ++y) {
    const Color* row = &pixels_.at(rect.x0, y);
    colors.insert(colors.end(), row, row + rect.width());
  }
}

}  // namespace pprt
