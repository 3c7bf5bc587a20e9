#include "parallel/master/mosaic.h"

#include <algorithm>
#include <cstddef>

namespace pprt {

Mosaic::Mosaic(const TileGrid& grid)
    : grid_(grid),
      image_(grid.width, grid.height),
      ranks_(static_cast<std::size_t>(grid.tile_count()), -1),
      ages_(static_cast<std::size_t>(grid.tile_count())) {}

void Mosaic::paste(int from, const PixelMessage& message) {
  std::size_t next = 0;
  const auto paste_tile = [&](std::int32_t tile, bool by_owner) {
    if (tile < 0 || tile >= grid_.tile_count()) throw ProtocolError("pixels of a tile that is none");
    const PixelRect rect = grid_.pixels(tile);
    if (message.colors.size() - next < rect.area()) throw ProtocolError("pixels are missing in a message");
    const Color* row = message.colors.data() + next;
    next += rect.area();
    const auto t = static_cast<std::size_t>(tile);
    const Age age{message.frame_index, by_owner};
    if (age < ages_[t]) return;
    ages_[t] = age;
    ranks_[t] = from;
    for (int y = rect.y0; y < rect.y1; ++y, row += rect.width())
      std::copy_n(row, rect.width(), &image_.at(rect.x0, y));
  };
  for (const TileReport& tile : message.tiles) paste_tile(tile.tile, true);
  for (const std::int32_t tile : message.given) paste_tile(tile, false);
}

int Mosaic::fill_gaps(const Mosaic& before) {
  int filled = 0;
  for (int tile = 0; tile < grid_.tile_count(); ++tile) {
    const auto t = static_cast<std::size_t>(tile);
    if (ages_[t].frame >= 0) continue;
    ages_[t] = before.ages_[t];
    ranks_[t] = before.ranks_[t];
    ++filled;
    const PixelRect rect = grid_.pixels(tile);
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) image_.at(x, y) = before.image_.at(x, y);
    }
  }
  return filled;
}

}  // namespace pprt
