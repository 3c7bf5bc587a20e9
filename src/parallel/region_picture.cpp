#include "parallel/region_picture.h"

namespace pprt {

void RegionPicture::append_tile(const TileGrid& grid, int tile, std::vector<Color>& colors) const {
  const PixelRect rect = grid.pixels(tile);
  for (int y = rect.y0; y < rect.y1; ++y) {
    const Color* row = &pixels_.at(rect.x0, y);
    colors.insert(colors.end(), row, row + rect.width());
  }
}

}  // namespace pprt
