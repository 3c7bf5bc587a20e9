#include "parallel/rank/picture_refresh.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

namespace pprt {

void PictureRefresh::reconstruct(Sampler& sampler, std::span<const std::int32_t> further_tiles) {
  sampler.paint(further_tiles, pixels_);
  const Region& region = sampler.region();
  tiles_.assign(region.tiles().begin(), region.tiles().end());
  shows_.assign(static_cast<std::size_t>(region.grid().tile_count()), sampler.size());
}

double PictureRefresh::unshown(const Region& region) const {
  const auto shown =
      std::count_if(tiles_.begin(), tiles_.end(), [&](std::int32_t tile) { return region.owns_tile(tile); });
  const double all = static_cast<double>(std::max<std::size_t>(region.tiles().size(), 1));
  return 1 - static_cast<double>(shown) / all;
}

// Keeps what is shown of tiles while the region becomes another one. Returns the tiles that nothing is shown
// of yet.
std::vector<std::int32_t> PictureRefresh::keep_shown(const Region& region,
                                                     std::span<const std::int32_t> further_tiles) {
  const auto is_shown = [this](std::int32_t tile) {
    return std::find(tiles_.begin(), tiles_.end(), tile) != tiles_.end();
  };
  std::vector<std::int32_t> missing;
  std::copy_if(region.tiles().begin(), region.tiles().end(), std::back_inserter(missing),
               std::not_fn(is_shown));
  std::copy_if(further_tiles.begin(), further_tiles.end(), std::back_inserter(missing),
               std::not_fn(is_shown));
  std::erase_if(tiles_, [&](std::int32_t tile) { return !region.owns_tile(tile); });
  move_to(region.bounds_with(further_tiles));
  return missing;
}

void PictureRefresh::move_to(const PixelRect& bounds) {
  if (pixels_.bounds == bounds) return;
  PixelBlock moved{bounds, std::vector<Color>(bounds.area())};
  const PixelRect& before = pixels_.bounds;
  const int x0 = std::max(bounds.x0, before.x0), x1 = std::min(bounds.x1, before.x1);
  for (int y = std::max(bounds.y0, before.y0); x0 < x1 && y < std::min(bounds.y1, before.y1); ++y) {
    const Color* row = &pixels_.at(x0, y);
    std::copy(row, row + (x1 - x0), moved.colors.begin() + (&moved.at(x0, y) - moved.colors.data()));
  }
  pixels_ = std::move(moved);
}

double PictureRefresh::refresh(Sampler& sampler, std::span<const std::int32_t> further_tiles, bool in_parts,
                               const std::function<bool()>& is_over) {
  const Region& region = sampler.region();
  if (tiles_.empty() || (!in_parts && !shows_all_of(region, further_tiles))) {
    reconstruct(sampler, further_tiles);
    return 1;
  }
  const auto shows = [this](std::int32_t tile) -> std::size_t& {
    return shows_[static_cast<std::size_t>(tile)];
  };
  const std::vector<std::int32_t> missing = keep_shown(region, further_tiles);
  if (!missing.empty())
    sampler.repaint(
        missing, [] { return false; }, pixels_);
  const auto waiting = std::find_if(tiles_.begin(), tiles_.end(),
                                    [&](std::int32_t tile) { return shows(tile) == sampler.size(); });
  std::size_t done = 0;
  if (waiting != tiles_.begin() && !is_over()) {
    const std::span<const std::int32_t> stale(tiles_.begin(), waiting);
    done = sampler.repaint(stale, is_over, pixels_);
    for (const std::int32_t tile : stale.first(done)) shows(tile) = sampler.size();
    std::rotate(tiles_.begin(), tiles_.begin() + static_cast<std::ptrdiff_t>(done), tiles_.end());
  }
  for (const std::int32_t tile : missing) {
    shows(tile) = sampler.size();
    if (region.owns_tile(tile)) tiles_.push_back(tile);
  }
  const double all = static_cast<double>(std::max<std::size_t>(tiles_.size(), 1));
  return std::min(static_cast<double>(done + missing.size()) / all, 1.0);
}

bool PictureRefresh::shows_all_of(const Region& region, std::span<const std::int32_t> further_tiles) const {
  return further_tiles.empty() && tiles_.size() == region.tiles().size() &&
         pixels_.bounds == region.bounds() &&
         std::all_of(tiles_.begin(), tiles_.end(), [&](int tile) { return region.owns_tile(tile); });
}

void PictureRefresh::append_tile(const TileGrid& grid, int tile, std::vector<Color>& colors) const {
  const PixelRect rect = grid.pixels(tile);
  for (int y = rect.y0; y < rect.y1; ++y) {
    const Color* row = &pixels_.at(rect.x0, y);
    colors.insert(colors.end(), row, row + rect.width());
  }
}

}  // namespace pprt
