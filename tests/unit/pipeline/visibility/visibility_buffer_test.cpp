// The visibility buffer on shapes made by hand.
#include "pipeline/visibility/visibility_buffer.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "unit/pipeline/rectangles.h"

namespace pprt::visibility_buffer_test {
namespace {

constexpr int kSize = 64;

using test::shapes_of, test::triangle, test::Rectangle;

}  // namespace

TEST_CASE("visibility buffer: pixels of several surfaces are counted in the tiles seen so far") {
  for (const auto& fineness : {VisibilityBuffer::kCoarse, VisibilityBuffer::kFine}) {
    VisibilityBuffer buffer(kSize, kSize, shapes_of({{10.3, 3.3, 40.7, 50.7, 1}, {12, 12, 20, 20, 2}}));
    buffer.forget(fineness);
    CHECK(buffer.mixed_pixels() == 0);
    REQUIRE(buffer.is_known());
    std::size_t mixed = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x)
        mixed += !buffer.tile(x, y).is_uniform(buffer.in_tile(x), buffer.in_tile(y), 1);
    }
    CHECK(mixed > 150);
    CHECK(buffer.mixed_pixels() == mixed);
    CHECK(buffer.mixed_within({0, 0, kSize, kSize}) == static_cast<std::int64_t>(mixed));
    for (const PixelRect& part :
         {PixelRect{3, 2, 45, 51}, PixelRect{32, 16, 48, 64}, PixelRect{11, 9, 12, 13}}) {
      std::int64_t within = 0;
      for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; ++x)
          within += !buffer.tile(x, y).is_uniform(buffer.in_tile(x), buffer.in_tile(y), 1);
      }
      CHECK(buffer.mixed_within(part) == within);
    }
    buffer.forget();
    CHECK(buffer.mixed_pixels() == 0);
    REQUIRE(buffer.is_known());
    buffer.tile(0, 0);
    CHECK(buffer.mixed_pixels() > 0);
    CHECK(buffer.mixed_pixels() < mixed);
  }
}

TEST_CASE(
    "visibility buffer: the nearest is seen, whatever the order, and the background where there is none") {
  const std::vector<Rectangle> rectangles = {
      {10, 10, 50, 50, 1}, {20.25, 20.25, 30.25, 30.25, 2}, {25, 5, 35, 40, 0.5}};
  for (const auto& fineness :
       {VisibilityBuffer::kCoarse, VisibilityBuffer::kMiddle, VisibilityBuffer::kFine}) {
    VisibilityBuffer buffer(kSize, kSize, shapes_of(rectangles));
    buffer.forget(fineness);
    REQUIRE(buffer.is_known());
    const int side = fineness.points_per_side;
    int wrong = 0;
    for (int y = 0; y <= side * kSize; ++y) {
      for (int x = 0; x <= side * kSize; ++x) {
        const double u = static_cast<double>(x) / side, v = static_cast<double>(y) / side;
        std::uint32_t nearest = 0;
        double most = 0;
        for (std::size_t i = 0; i < rectangles.size(); ++i) {
          const Rectangle& r = rectangles[i];
          if (u >= r.x0 && u <= r.x1 && v >= r.y0 && v <= r.y1 && r.nearness > most)
            most = r.nearness, nearest = static_cast<std::uint32_t>(i + 1);
        }
        wrong += buffer.at(x, y) != nearest ? 1 : 0;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("visibility buffer: a square is uniform if all its points see one surface") {
  PrimitiveShapes shapes = shapes_of({{0, 0, 20, 64, 1}, {20, 0, 40.5, 64, 1}, {50.2, 50.2, 50.8, 50.8, 1}});
  for (const bool is_one : {false, true}) {
    const std::vector<std::uint32_t> surfaces = {0, 1, is_one ? 1U : 2U, 3};
    shapes.surfaces = surfaces;
    VisibilityBuffer buffer(kSize, kSize, shapes);
    for (const auto& fineness : {VisibilityBuffer::kCoarse, VisibilityBuffer::kFine}) {
      buffer.forget(fineness);
      REQUIRE(buffer.is_known());
      const int side = fineness.points_per_side;
      for (const int size : {1, 2, 8}) {
        int wrong = 0;
        for (int y = 0; y < kSize; y += size) {
          for (int x = 0; x < kSize; x += size) {
            bool is_uniform = true;
            for (int v = side * y; v <= side * (y + size); ++v)
              for (int u = side * x; u <= side * (x + size); ++u)
                is_uniform = is_uniform && buffer.at(u, v) == buffer.at(side * x, side * y);
            const int tile = buffer.tile_pixels();
            wrong += buffer.tile(x, y).is_uniform(x % tile, y % tile, size) != is_uniform ? 1 : 0;
          }
        }
        INFO("points " << side << ", squares of " << size << ", one surface " << is_one);
        CHECK(wrong == 0);
      }
    }
  }
}

// The share of a surface in the pixel (10, 10).
double share_of(VisibilityBuffer& buffer, std::uint32_t surface) {
  const SeenInPixel& seen = buffer.seen_in(10, 10);
  const VisibleTile& tile = buffer.tile(10, 10);
  double share = 0, sum = 0;
  for (std::size_t i = 0; i < seen.count; ++i) {
    sum += seen.shares[i];
    if (tile.surfaces()[seen.numbers[i]] == surface) share += seen.shares[i];
  }
  CHECK(sum == Approx(1));
  return share;
}

TEST_CASE("visibility buffer: shares are areas") {
  VisibilityBuffer buffer(kSize, kSize,
                          shapes_of({{0, 0, 64, 64, 1}, {0, 0, 10.25, 64, 2}, {0, 0, 64, 10.5, 3}}));
  REQUIRE(buffer.is_known());
  CHECK(share_of(buffer, 1) == Approx(0.75 * 0.5).margin(0.02));
  CHECK(share_of(buffer, 2) == Approx(0.25 * 0.5).margin(0.02));
  CHECK(share_of(buffer, 3) == Approx(0.5).margin(0.02));
  CHECK(share_of(buffer, 0) == 0);
  CHECK(buffer.at(Vec2d(10.1, 10.4)) == 3);
  CHECK(buffer.at(Vec2d(10.1, 10.6)) == 2);
  CHECK(buffer.at(Vec2d(10.4, 10.6)) == 1);
}

TEST_CASE("visibility buffer: a pixel whose points all see one surface shows that alone") {
  VisibilityBuffer buffer(kSize, kSize, shapes_of({{0, 0, 64, 64, 1}, {10.3, 10.3, 10.4, 10.4, 2}}));
  REQUIRE(buffer.is_known());
  CHECK(share_of(buffer, 1) == 1);
  CHECK(buffer.seen_in(10, 10).places[0] == Vec2f(0.5F, 0.5F));
}

TEST_CASE("visibility buffer: a place is the middle of the points that see a primitive") {
  VisibilityBuffer buffer(kSize, kSize, shapes_of({{0, 0, 64, 64, 1}, {0, 0, 10.3, 64, 2}}));
  for (const auto& fineness : {VisibilityBuffer::kMiddle, VisibilityBuffer::kFine}) {
    buffer.forget(fineness);
    REQUIRE(buffer.is_known());
    const bool is_fine = fineness == VisibilityBuffer::kFine;
    const SeenInPixel& seen = buffer.seen_in(10, 10);
    const VisibleTile& tile = buffer.tile(10, 10);
    REQUIRE(seen.count == 2);
    for (std::size_t i = 0; i < seen.count; ++i) {
      // Columns of points at 0, 1/4 and so on, those on the border with half the weight.
      const bool is_left = tile.surfaces()[seen.numbers[i]] == 2;
      const double x = is_left ? (is_fine ? 1.0 / 6 : 0) : is_fine ? (0.5 + 0.75 + 0.5) / 2.5 : 2.0 / 3;
      CHECK(seen.places[i].x == Approx(x));
      CHECK(seen.places[i].y == Approx(0.5));
    }
  }
}

TEST_CASE("visibility buffer: what lies between the points of a pixel has its share, unless it is coarse") {
  const auto fineness =
      GENERATE(VisibilityBuffer::kCoarse, VisibilityBuffer::kMiddle, VisibilityBuffer::kFine);
  // Two halves of a wall, and a strip before them that no point meets; behind them nothing is seen.
  VisibilityBuffer buffer(
      kSize, kSize,
      shapes_of(
          {{0, 0, 10.3, 64, 1}, {10.3, 0, 64, 64, 1}, {0, 10.58, 64, 10.7, 2}, {0, 10.4, 64, 10.45, 0.5}}));
  buffer.forget(fineness);
  REQUIRE(buffer.is_known());
  const bool is_coarse = fineness == VisibilityBuffer::kCoarse;
  CHECK(share_of(buffer, 3) == Approx(is_coarse ? 0 : 0.12).margin(0.03));
  CHECK(share_of(buffer, 1) == Approx(is_coarse ? 0.3 : 0.264).margin(0.03));
  CHECK(share_of(buffer, 2) == Approx(is_coarse ? 0.7 : 0.616).margin(0.03));
  CHECK(share_of(buffer, 4) == 0);
}

TEST_CASE(
    "visibility buffer: a strip between points is seen beside nearer things, where these leave a part") {
  const auto fineness = GENERATE(VisibilityBuffer::kMiddle, VisibilityBuffer::kFine);
  VisibilityBuffer buffer(kSize, kSize,
                          shapes_of({{0, 0, 64, 10.05, 2}, {0, 10.3, 64, 10.45, 1}, {0, 10.98, 64, 64, 2}}));
  buffer.forget(fineness);
  REQUIRE(buffer.is_known());
  CHECK(share_of(buffer, 2) == Approx(0.15).margin(0.03));
  CHECK(share_of(buffer, 0) == Approx(0.78).margin(0.03));
}

TEST_CASE("visibility buffer: the background has a share where it shows between points alone") {
  const auto fineness = GENERATE(VisibilityBuffer::kMiddle, VisibilityBuffer::kFine);
  VisibilityBuffer buffer(kSize, kSize, shapes_of({{0, 0, 64, 10.55, 1}, {0, 10.7, 64, 64, 1}}));
  buffer.forget(fineness);
  REQUIRE(buffer.is_known());
  CHECK(share_of(buffer, 1) == Approx(0.55).margin(0.03));
  CHECK(share_of(buffer, 2) == Approx(0.3).margin(0.03));
  CHECK(share_of(buffer, 0) == Approx(0.15).margin(0.03));
}

TEST_CASE("visibility buffer: of many thin things in a pixel each has its share") {
  const auto fineness = GENERATE(VisibilityBuffer::kMiddle, VisibilityBuffer::kFine);
  const bool lie_down = GENERATE(false, true);
  constexpr int kStrips = 40;
  std::vector<Rectangle> strips;
  for (int i = 0; i < kStrips; ++i) {
    const double at = 10 + (i - 0.25) / kStrips, to = at + 0.5 / kStrips;  // the points meet five
    strips.push_back(lie_down ? Rectangle{0, at, 64, to, 1} : Rectangle{at, 0, to, 64, 1});
  }
  VisibilityBuffer buffer(kSize, kSize, shapes_of(strips));
  buffer.forget(fineness);
  REQUIRE(buffer.is_known());
  CHECK(share_of(buffer, 0) == Approx(0.5).margin(0.06));
  double worst = 0;
  for (int i = 1; i <= kStrips; ++i) worst = std::max(worst, share_of(buffer, static_cast<std::uint32_t>(i)));
  CHECK(worst < 0.05);
}

TEST_CASE("visibility buffer: of two that are equally near the first is seen") {
  const Rectangle one = {8, 8, 40, 40, 1};
  VisibilityBuffer buffer(kSize, kSize, shapes_of({one, one}));
  REQUIRE(buffer.is_known());
  CHECK(buffer.at(100, 100) == 1);
}

TEST_CASE("visibility buffer: a tile of more primitives than 16 bits count shows those that are seen") {
  constexpr std::size_t kMany = 70'000;
  std::vector<Rectangle> rectangles(kMany, {30, 30, 31, 31, 0.5});
  rectangles.push_back({29, 29, 33, 33, 1});  // hides them all
  rectangles.push_back({40, 40, 50, 50, 1});
  VisibilityBuffer buffer(kSize, kSize, shapes_of(rectangles));
  REQUIRE(buffer.is_known());
  CHECK(buffer.at(4 * 30 + 2, 4 * 30 + 2) == kMany + 1);
  CHECK(buffer.at(4 * 45, 4 * 45) == kMany + 2);
  CHECK(buffer.at(Vec2d(39.9, 45.03)) == 0);
  CHECK(buffer.at(Vec2d(40.1, 45.03)) == kMany + 2);
}

TEST_CASE(
    "visibility buffer: a surface has one number in a tile, whichever of its primitives is met first there") {
  constexpr std::uint32_t kMany = 70'000;  // more than 16 bits count: what is seen gets numbers by place
  std::vector<Rectangle> rectangles(kMany, {30, 30, 31, 31, 0.5});
  rectangles.push_back({29, 29, 33, 33, 1});
  rectangles.push_back({17, 17, 20, 20, 1});  // before it in the tile
  std::vector<std::uint32_t> surfaces(kMany + 3);
  std::iota(surfaces.begin(), surfaces.end(), 0U);
  surfaces[kMany + 2] = kMany + 1;
  PrimitiveShapes shapes = shapes_of(rectangles);
  shapes.surfaces = surfaces;
  VisibilityBuffer buffer(kSize, kSize, shapes);
  REQUIRE(buffer.is_known());
  const VisibleTile& tile = buffer.tile(18, 18);
  const auto number_at = [&](int x, int y) { return tile.row(4 * (y - 16))[4 * (x - 16)]; };
  REQUIRE(number_at(18, 18) != number_at(31, 31));
  CHECK(tile.first_of_surface()[number_at(18, 18)] == tile.first_of_surface()[number_at(31, 31)]);
}

TEST_CASE("visibility buffer: nothing is known where a shape is unknown, and all anew after forget()") {
  bool is_known = false;
  double left = 8;
  VisibilityBuffer buffer(kSize, kSize,
                          {[&](std::uint32_t, ImageShape& shape) {
                             shape.kind = is_known ? ImageShape::Kind::kFacets : ImageShape::Kind::kUnknown;
                             shape.facets = {triangle({{{left, 0}, {left + 30, 0}, {left, 60}}}, 1)};
                           },
                           1});
  CHECK_FALSE(buffer.is_known());
  is_known = true;
  buffer.forget();
  REQUIRE(buffer.is_known());
  CHECK(buffer.at(4 * 9, 4) == 1);
  left = 20;
  CHECK(buffer.at(4 * 9, 4) == 1);
  buffer.forget();
  REQUIRE(buffer.is_known());
  CHECK(buffer.at(4 * 9, 4) == 0);
  REQUIRE_FALSE(buffer.tile(20, 16).is_uniform(0, 0, 16));  // the edge goes through this tile
  left = 200;                                               // out of the picture
  buffer.forget();
  REQUIRE(buffer.is_known());
  CHECK((buffer.at(4 * 25, 4) == 0 && buffer.tile(20, 16).is_uniform(0, 0, 16)));
  CHECK_FALSE(VisibilityBuffer(kSize, kSize, {}).is_known());
}

TEST_CASE(
    "visibility buffer: more shapes than are worth it count as not known, and none are asked for at a limit "
    "of 0") {
  int asked = 0;
  const PrimitiveShapes two = shapes_of({{8, 8, 40, 40, 1}, {8, 8, 20, 20, 2}});  // of two facets each
  const auto count = [&](std::uint32_t primitive, ImageShape& shape) {
    ++asked;
    two.project(primitive, shape);
  };
  VisibilityBuffer buffer(kSize, kSize, {count, 2});
  buffer.limit(30, {10}, {0, 0, kSize, kSize});
  CHECK_FALSE(buffer.is_known());
  buffer.limit(40, {10}, {0, 0, kSize, kSize});
  buffer.forget();
  CHECK(buffer.is_known());
  const int before = asked;
  buffer.limit(0);
  buffer.forget();
  CHECK_FALSE(buffer.is_known());
  CHECK(asked == before);
}

TEST_CASE("visibility buffer: shapes beyond those that were seen have a price of their own") {
  const SeeingPrice price{.each = 20, .seen = 2, .further = 5};
  CHECK(price.of(1) == 20);
  CHECK(price.of(2) == 40);
  CHECK(price.of(4) == 50);
  CHECK(SeeingPrice{.each = 20}.of(1000) == 20000);
}

// Prices: 1.25 for a facet and .75 for a quadric, .6 for each in a tile, 7 for the tile, .2 and .55 for a
// block of 8 x 8 points.
TEST_CASE("visibility buffer: its work is of what it projects, tries in tiles and rasterises in blocks") {
  const auto work_of = [](const PrimitiveShapes& shapes) {
    VisibilityBuffer buffer(kSize, kSize, shapes);
    buffer.forget(VisibilityBuffer::kCoarse);
    REQUIRE(buffer.is_known());
    buffer.tile(0, 0);  // of four; 32 x 32 pixels, 64 x 64 intervals
    return buffer.work();
  };
  const auto one = [](const ImageShape& shape) {
    return PrimitiveShapes{[shape](std::uint32_t, ImageShape& to) { to = shape; }, 1};
  };
  ImageShape triangles;
  triangles.kind = ImageShape::Kind::kFacets;
  triangles.facets = {triangle({{{1, 1}, {3.5, 1}, {1, 3.5}}}, 1)};  // in the first block
  CHECK(work_of(one(triangles)) == Approx(2.5 + 1.2 + 14 + 0.4));
  triangles.facets.push_back(triangle({{{5, 1}, {7.5, 1}, {5, 3.5}}}, 1));  // in the second
  CHECK(work_of(one(triangles)) == Approx(2 * (2.5 + 1.2 + 0.4) + 14));
  triangles.facets = {
      triangle({{{40, 1}, {43, 1}, {40, 4}}}, 1)};  // in the next tile, projected to be bounded
  CHECK(work_of(one(triangles)) == Approx(2.5 + 14));
  ImageShape disc;  // in the first block
  disc.kind = ImageShape::Kind::kQuadric;
  disc.quadric.discriminant = {1.5 - 2 * 2.25 * 2.25, 2 * 2.25, 2 * 2.25, -1, 0, -1};
  disc.quadric.middle = {-2, 0, 0};
  disc.quadric.bounds = {1, 1, 3.5F, 3.5F};
  CHECK(work_of(one(disc)) == Approx(1.5 + 1.2 + 14 + 1.1));
}

TEST_CASE("visibility buffer: what is bounded is projected when a tile that it may meet is seen first") {
  const std::vector<Rectangle> rectangles = {{2, 2, 14, 14, 1}, {40, 40, 60, 60, 1}, {4, 4, 60, 60, 0.5}};
  const PrimitiveShapes all = shapes_of(rectangles);
  std::vector<std::uint32_t> asked;
  PrimitiveShapes shapes = all;
  shapes.project = [&](std::uint32_t primitive, ImageShape& shape) {
    asked.push_back(primitive);
    all.project(primitive, shape);
  };
  shapes.bound = [&](std::uint32_t first, std::span<ShapeBounds> bounds) {
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const Rectangle& r = rectangles.at(first + i);
      bounds[i] = {{static_cast<float>(r.x0), static_cast<float>(r.y0), static_cast<float>(r.x1),
                    static_cast<float>(r.y1)},
                   2};
    }
  };
  VisibilityBuffer buffer(kSize, kSize, shapes), eager(kSize, kSize, all);
  REQUIRE((buffer.is_known() && eager.is_known()));
  CHECK(asked.empty());
  buffer.tile(0, 0);
  CHECK(asked == std::vector<std::uint32_t>{1, 3});
  int wrong = 0;
  for (int y = 0; y <= 4 * kSize; ++y)
    for (int x = 0; x <= 4 * kSize; ++x) wrong += buffer.at(x, y) != eager.at(x, y) ? 1 : 0;
  CHECK(wrong == 0);
  CHECK(asked == std::vector<std::uint32_t>{1, 3, 2});
  // The limit is about a part of the picture: four triangles of the first and the third meet it.
  buffer.limit(30, {10}, {0, 0, 20, 20});
  buffer.forget();
  CHECK_FALSE(buffer.is_known());
  buffer.limit(40, {10}, {0, 0, 20, 20});
  buffer.forget();
  CHECK(buffer.is_known());
  // What may be anywhere is projected at once, and whether it has a shape is known then.
  shapes.bound = [](std::uint32_t, std::span<ShapeBounds> bounds) {
    for (ShapeBounds& bound : bounds) bound = {kEverywhere, 2};
  };
  asked.clear();
  VisibilityBuffer anywhere(kSize, kSize, shapes);
  CHECK(anywhere.is_known());
  CHECK(asked == std::vector<std::uint32_t>{1, 2, 3});
}

}  // namespace pprt::visibility_buffer_test
