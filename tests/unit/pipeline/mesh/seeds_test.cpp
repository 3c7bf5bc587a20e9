#include "pipeline/mesh/seeds.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::seeds_test {

TEST_CASE("seeds: one in 16 x 16 pixels up to 4096 x 4096, and no more in larger pictures") {
  CHECK(seed_points(256, 256, 1).size() == 17 * 17);
  CHECK(seed_points(4096, 4096, 1).size() == 257 * 257);
  CHECK(seed_points(16384, 16384, 1).size() == 257 * 257);
  const std::vector<Vec2d> wide = seed_points(16384, 2048, 1);
  CHECK(wide.size() <= 1.02 * kMostSeeds);
  CHECK(wide.size() >= 0.98 * kMostSeeds);
}

TEST_CASE("seeds: they cover every part of a picture, its corners first") {
  for (const auto& [width, height] : {std::pair(256, 192), std::pair(1, 1), std::pair(8192, 8192)}) {
    CAPTURE(width, height);
    const std::vector<Vec2d> points = seed_points(width, height, 7);
    const double w = width, h = height;
    REQUIRE(points.size() >= 4);
    CHECK((points[0] == Vec2d(0, 0) && points[1] == Vec2d(w, 0) && points[2] == Vec2d(w, h) &&
           points[3] == Vec2d(0, h)));
    const double spacing = std::max(kSeedSpacing, std::sqrt(w * h / kMostSeeds));
    const int columns = std::max(1, static_cast<int>(w / spacing / 2)),
              rows = std::max(1, static_cast<int>(h / spacing / 2));
    std::vector<int> in_block(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
    for (const Vec2d& p : points) {
      const int x = std::min(static_cast<int>(p.x / w * columns), columns - 1);
      const int y = std::min(static_cast<int>(p.y / h * rows), rows - 1);
      ++in_block[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(x)];
    }
    CHECK(std::find(in_block.begin(), in_block.end(), 0) == in_block.end());
  }
}

}  // namespace pprt::seeds_test
