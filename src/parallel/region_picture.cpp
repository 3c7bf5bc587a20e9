#include "parallel/region_picture.h"

namespace pprt {

void RegionPicture::append_tile(const TileGrid& grid, int tile, std::vector<float>& rgb) const {
  const PixelRect rect = grid.pixels(tile);
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const Color& c = pixels_.at(x, y);
      rgb.insert(rgb.end(), {c.x, c.y, c.z});
    }
  }
}

}  // namespace pprt
