#include "parallel/region_picture.h"

#include <algorithm>

namespace pprt {
namespace {

PixelRect united(const PixelRect& a, const PixelRect& b) {
  if (a.area() == 0) return b;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

void RegionPicture::reconstruct_region(const SampleMesh& mesh, std::span<const std::int32_t> further_tiles) {
  PixelRect bounds = mesh.region().bounds();
  for (const int tile : further_tiles) bounds = united(bounds, mesh.region().grid().pixels(tile));
  reconstruct(mesh, bounds, pixels_, buffers_, rule_, knows_shapes_ ? &projected_shapes_ : nullptr);
}

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
