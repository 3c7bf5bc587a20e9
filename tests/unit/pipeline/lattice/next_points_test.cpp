// Points that the lattice sampler wants together, and those that no sample comes for.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "unit/pipeline/lattice/refined_picture.h"

namespace pprt::next_points_test {
namespace {

constexpr int kSize = 64;

// A bright disc.
Color color_at(double x, double y) {
  return std::hypot(x - 27.3, y - 30.7) <= 21.4 ? Color(0.9F, 0.7F, 0.2F) : Color(0.1F, 0.1F, 0.3F);
}
RaySample sample_at(double x, double y) {
  RaySample sample;
  sample.color = color_at(x, y), sample.primitive = 1;
  return sample;
}

// The region of the first columns of tiles, 8 pixels wide.
Region first_columns(int count) {
  const TileGrid grid{kSize, kSize, 8};
  std::vector<std::uint8_t> owned;
  for (int tile = 0; tile < grid.tile_count(); ++tile) owned.push_back(tile % grid.columns() < count ? 1 : 0);
  return {grid, owned};
}

std::vector<Vec2d> next(LatticeRefiner& refiner, std::size_t most) {
  const std::span<const Vec2d> points = refiner.next_points(most);
  return {points.begin(), points.end()};
}

void insert(LatticeRefiner& refiner, const std::vector<Vec2d>& points) {
  for (const Vec2d& p : points) CHECK(refiner.insert(p, sample_at(p.x, p.y)));
}

}  // namespace

TEST_CASE("next points: they are of one level, and as good as one by one") {
  constexpr std::size_t kSamples = 1500, kAtOnce = 16;
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}), {});
  std::size_t calls = 0, made = 0;
  while (made < kSamples) {
    refiner.expect(static_cast<double>(kSamples - made));
    const std::size_t most = std::min(kAtOnce, kSamples - made);
    const std::vector<Vec2d> points = next(refiner, most);
    REQUIRE((!points.empty() && points.size() <= most));
    const LatticeNode first = node_at(points[0]);
    for (const Vec2d& p : points) {
      REQUIRE(is_base(node_at(p)) == is_base(first));
      if (!is_base(first)) CHECK(level_of(node_at(p)) == level_of(first));
    }
    insert(refiner, points);
    made += points.size(), ++calls;
  }
  CHECK(calls < kSamples / 2);
  PixelBlock pixels;
  refiner.paint({0, 0, kSize, kSize}, pixels);
  LatticeRefiner single(Region::whole({kSize, kSize, 32}), {});
  const PixelBlock one_by_one = test::picture_of(single, kSize, kSamples, sample_at);
  CHECK(test::error_of(pixels, 0, kSize, color_at) < 1.1 * test::error_of(one_by_one, 0, kSize, color_at));
}

TEST_CASE("next points: those without samples come again, but for those that another sample took") {
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}), {});
  int full = 0;
  for (int samples = 0; samples < 600;) {
    std::vector<Vec2d> points = next(refiner, 4);
    REQUIRE_FALSE(points.empty());
    samples += static_cast<int>(points.size());
    if (points.size() == 4) {
      // The first arrives, and another rank's sample at the third. No others are chosen meanwhile.
      insert(refiner, {points[0], points[2]});
      points.erase(points.begin() + 2), points.erase(points.begin());
      CHECK(next(refiner, 4) == points);
      CHECK(next(refiner, 1).size() == 1);
      CHECK(next(refiner, 4) == points);
      ++full;
    }
    insert(refiner, points);
  }
  CHECK(full > 20);
}

TEST_CASE("next points: those that nothing came for before the region changed stay candidates") {
  LatticeRefiner refiner(first_columns(6), {});
  for (int samples = 0; samples < 500;) {
    const std::vector<Vec2d> points = next(refiner, 16);
    insert(refiner, points);
    samples += static_cast<int>(points.size());
  }
  std::set<std::pair<double, double>> missing;
  for (const Vec2d& p : next(refiner, 16)) missing.insert({p.x, p.y});
  REQUIRE_FALSE(missing.empty());
  refiner.set_region(first_columns(7));
  for (std::vector<Vec2d> points = next(refiner, 16); !points.empty(); points = next(refiner, 16)) {
    insert(refiner, points);
    for (const Vec2d& p : points) missing.erase({p.x, p.y});
  }
  CHECK(missing.empty());
}

}  // namespace pprt::next_points_test
