#include "pipeline/lattice/unsampled_surfaces.h"

#include <algorithm>
#include <cstdlib>

namespace pprt {

void UnsampledSurfaces::clear() {
  for (std::vector<UnsampledSurface>& all : of_tile_) all.clear();
  counts_.fill(0);
}

std::span<UnsampledSurface> UnsampledSurfaces::find(VisibilityBuffer& visibility,
                                                    const SurfaceSamples& samples,
                                                    const LatticeNode& corner) {
  constexpr int kBasePixels = kBaseSide / kPixelSide;
  const int density = visibility.points_per_side();
  const int x_in_tile = visibility.in_tile(corner.x / kPixelSide);
  const int y_in_tile = visibility.in_tile(corner.y / kPixelSide);
  const VisibleTile& tile = visibility.tile(corner.x / kPixelSide, corner.y / kPixelSide);
  found_.clear();
  if (tile.is_uniform(x_in_tile, y_in_tile, kBasePixels)) return {};
  const int side = density * kBasePixels, left = density * x_in_tile, top = density * y_in_tile;
  const std::span<const std::uint16_t> first = tile.first_of_surface();
  if (points_.size() < first.size()) points_.resize(first.size());
  numbers_.clear();
  // Calls visit(sums, number, row, begin, end) for the points in a row that are on one surface.
  const auto for_each_run = [&](const auto& visit) {
    for (int y = 0; y < side; ++y) {
      const std::uint16_t* row = tile.row(top + y) + left;
      for (int x = 0; x < side;) {
        const int begin = x;
        while (++x < side && row[x] == row[begin]) continue;
        visit(points_[first[row[begin]]], first[row[begin]], y, begin, x);
      }
    }
  };
  for_each_run([&](Points& points, std::uint16_t number, int y, int begin, int end) {
    if (points.count == 0) numbers_.push_back(number);
    const int run = end - begin;
    points.count += run, points.x += run * (begin + end - 1) / 2, points.y += run * y;
  });
  for (const std::uint16_t number : numbers_) {
    const std::uint32_t surface = tile.surfaces()[number];
    Points& points = points_[number];
    if (samples.has(corner, surface)) continue;
    points.unsampled = static_cast<int>(found_.size()), points.least = 1 << 30;
    found_.push_back(
        {corner, surface, static_cast<float>(points.count) / static_cast<float>(density * density)});
  }
  if (!found_.empty()) {
    for_each_run([&](const Points& points, std::uint16_t number, int y, int begin, int end) {
      if (points.unsampled < 0) return;
      const int x = std::clamp(points.x / points.count, begin, end - 1);
      const int distance = std::abs(x * points.count - points.x) + std::abs(y * points.count - points.y);
      if (distance >= points.least) return;
      points_[number].least = distance;
      found_[static_cast<std::size_t>(points.unsampled)].node = {corner.x + kPixelSide / density * x,
                                                                 corner.y + kPixelSide / density * y};
    });
  }
  for (const std::uint16_t number : numbers_) points_[number] = {};
  return found_;
}

void UnsampledSurfaces::take(int tile, NodeState least, std::vector<UnsampledSurface>& taken) {
  std::vector<UnsampledSurface>& all = of_tile_[static_cast<std::size_t>(tile)];
  std::erase_if(all, [&](const UnsampledSurface& surface) {
    if (surface.priority < least) return false;
    --counts_[surface.priority];
    taken.push_back(surface);
    return true;
  });
}

void UnsampledSurfaces::keep(int tile, const UnsampledSurface& surface) {
  of_tile_[static_cast<std::size_t>(tile)].push_back(surface);
  ++counts_[surface.priority];
}

}  // namespace pprt
