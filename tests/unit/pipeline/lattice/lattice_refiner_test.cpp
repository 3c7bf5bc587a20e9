// Pictures by the lattice sampler: where it samples, and what it paints.
#include "pipeline/lattice/lattice_refiner.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "unit/pipeline/lattice/disc_before_wall.h"

namespace pprt::lattice_refiner_test {
namespace {

constexpr int kWidth = 100, kHeight = 60;
constexpr int kBase = 14 * 9;  // corners of the base squares over it

// What an eye ray finds at an image point.
using Scene = std::function<RaySample(double x, double y)>;

Scene of_color(const std::function<Color(double x, double y)>& color) {
  return [=](double x, double y) {
    RaySample sample;
    sample.color = color(x, y);
    sample.primitive = 1;
    return sample;
  };
}

const Scene kFlat = of_color([](double, double) { return Color(0.25F, 0.5F, 0.75F); });
const Scene kLinear = of_color([](double x, double y) {
  return Color(static_cast<float>(x / 200), static_cast<float>(y / 100), static_cast<float>((x + y) / 300));
});

constexpr double kDiscX = 47.3, kDiscY = 28.7, kDiscRadius = 21.4;
bool in_disc(double x, double y) {
  return std::hypot(x - kDiscX, y - kDiscY) <= kDiscRadius;
}

// A disc, primitive 2, before a wall, primitive 1. Its edge is that of a shadow if both are one primitive.
Scene disc(bool is_primitive) {
  return [=](double x, double y) {
    RaySample sample;
    const bool inside = in_disc(x, y);
    sample.color = inside ? Color(0.9F, 0.7F, 0.2F) : Color(0.1F, 0.1F, 0.3F);
    sample.primitive = inside && is_primitive ? 2 : 1;
    return sample;
  };
}

const PrimitiveShapes kNoShapes;

// The shapes of disc(true), the disc to the right of its place by `by` pixels.
PrimitiveShapes shapes_of_disc(double by) {
  return test::disc_before_wall(kDiscX + by, kDiscY, kDiscRadius);
}

// Makes a number of samples, or fewer if it ends. Returns their points.
std::vector<Vec2d> sample(LatticeRefiner& sampler, const Scene& scene, int samples) {
  std::vector<Vec2d> points;
  for (int i = 0; i < samples; ++i) {
    sampler.expect(samples - i);
    const auto point = sampler.next_point();
    if (!point) break;
    points.push_back(*point);
    sampler.insert(*point, scene(point->x, point->y));
  }
  return points;
}

// A sampler with so many samples of a scene.
struct Sampled {
  Sampled(const Scene& scene, int samples, const PrimitiveShapes& shapes = kNoShapes)
      : sampler(Region::whole({kWidth, kHeight, 32}), shapes), points(sample(sampler, scene, samples)) {}

  LatticeRefiner sampler;
  std::vector<Vec2d> points;
};

PixelBlock painted(LatticeRefiner& sampler, const PixelRect& bounds = {0, 0, kWidth, kHeight}) {
  PixelBlock pixels;
  sampler.paint(bounds, pixels);
  return pixels;
}

// Root mean square against the mean over each pixel.
double error_of(const PixelBlock& pixels, const Scene& scene) {
  constexpr int kSide = 8;
  double sum = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      Color truth(0, 0, 0);
      for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) truth += scene(x + (i + 0.5) / kSide, y + (j + 0.5) / kSide).color;
      }
      const Color d = pixels.at(x, y) - truth * (1.0F / (kSide * kSide));
      sum += d.dot(d);
    }
  }
  return std::sqrt(sum / (3.0 * kWidth * kHeight));
}

double error_with(int samples, const Scene& scene, const PrimitiveShapes& shapes = kNoShapes) {
  Sampled sampled(scene, samples, shapes);
  return error_of(painted(sampled.sampler), scene);
}

}  // namespace

TEST_CASE("lattice sampler: one colour stays one colour") {
  for (const int samples : {kBase, 300, 3000}) {
    Sampled sampled(kFlat, samples);
    for (const Color& c : painted(sampled.sampler).colors) REQUIRE(c == Color(0.25F, 0.5F, 0.75F));
  }
  Sampled unfinished(kFlat, kBase - 1);
  CHECK(unfinished.sampler.least_samples() == kBase);
  const std::vector<Color> colors = painted(unfinished.sampler).colors;
  CHECK(std::count(colors.begin(), colors.end(), Color(0.25F, 0.5F, 0.75F)) < std::ssize(colors));
}

TEST_CASE("lattice sampler: a linear picture is exact after the base grid") {
  CHECK(error_with(kBase, kLinear) < 1e-6);
  CHECK(error_with(kBase - 1, kLinear) > 1e-6);  // one is missing
  CHECK(error_with(2000, kLinear) < 1e-6);
}

TEST_CASE("lattice sampler: no point is sampled twice, and none lies far outside") {
  const Sampled sampled(disc(false), 5000);
  const std::vector<Vec2d>& points = sampled.points;
  std::set<std::pair<double, double>> places;
  for (const Vec2d& p : points) {
    REQUIRE((p.x >= 0 && p.y >= 0 && p.x <= kWidth + 8 && p.y <= kHeight + 8));
    places.insert({p.x, p.y});
  }
  CHECK(places.size() == points.size());
  CHECK(sampled.sampler.samples() == points.size());
}

TEST_CASE("lattice sampler: samples crowd along edges") {
  const auto at_edge = [](const Scene& scene) {
    const std::vector<Vec2d> points = Sampled(scene, 2000).points;
    return std::count_if(points.begin(), points.end(), [](const Vec2d& p) {
      return std::abs(std::hypot(p.x - kDiscX, p.y - kDiscY) - kDiscRadius) < 1.5;
    });
  };
  // The band has 400 of 6,000 square pixels.
  CHECK(at_edge(disc(false)) > 700);
  CHECK(at_edge(kFlat) < 200);
}

TEST_CASE("lattice sampler: more samples bring less error, far less than a grid's") {
  const Scene scene = disc(false);
  double last = error_with(200, scene);
  for (const int samples : {400, 800, 1600}) {
    const double error = error_with(samples, scene);
    CAPTURE(samples, error, last);
    CHECK(error < 0.75 * last);
    last = error;
  }
  // One sample at each pixel's centre.
  PixelBlock grid{{0, 0, kWidth, kHeight}, {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) grid.colors.push_back(scene(x + 0.5, y + 0.5).color);
  }
  CHECK(last < 0.5 * error_of(grid, scene));  // with a quarter of its samples
}

TEST_CASE("lattice sampler: edges of known primitives are drawn where they are") {
  const Scene scene = disc(true);
  for (const int samples : {250, 500, 1000}) {
    const double known = error_with(samples, scene, shapes_of_disc(0));
    const double unknown = error_with(samples, scene),
                 beside = error_with(samples, scene, shapes_of_disc(1.5));
    CAPTURE(samples, known, unknown, beside);
    if (samples <= 500) CHECK(known < 0.3 * unknown);  // more samples find the edge without shapes
    CHECK(known < 0.5 * beside);                       // the control: shapes that lie elsewhere do not pass
  }
}

TEST_CASE("lattice sampler: a picture does not depend on how it is cut, nor on the one before") {
  Sampled sampled(disc(true), 1500, shapes_of_disc(0));
  LatticeRefiner& sampler = sampled.sampler;
  const PixelBlock whole = painted(sampler);
  for (const PixelRect& part :
       {PixelRect{0, 0, 37, 60}, PixelRect{37, 13, 100, 14}, PixelRect{99, 59, 100, 60}}) {
    const PixelBlock pixels = painted(sampler, part);
    REQUIRE(pixels.colors.size() == part.area());
    for (int y = part.y0; y < part.y1; ++y) {
      for (int x = part.x0; x < part.x1; ++x) REQUIRE(pixels.at(x, y) == whole.at(x, y));
    }
  }
  sampler.clear();
  CHECK(sampler.samples() == 0);
  CHECK(sample(sampler, disc(true), 1500) == sampled.points);
  CHECK(painted(sampler).colors == whole.colors);
  sample(sampler, of_color([](double, double) { return Color(1, 1, 1); }), 1);
  CHECK(painted(sampler).colors != whole.colors);  // the control: one sample shows
}

TEST_CASE("lattice sampler: it ends when nothing is worth a sample") {
  const std::size_t samples = Sampled(kFlat, 100'000).points.size();
  CHECK(samples > 1000);
  CHECK(samples < 2 * kWidth * kHeight);
}

TEST_CASE("lattice sampler: a picture of one pixel, and one without samples") {
  LatticeRefiner tiny(Region::whole({1, 1, 32}), kNoShapes);
  PixelBlock pixels;
  tiny.paint({0, 0, 1, 1}, pixels);
  CHECK(pixels.colors == std::vector{Color(0, 0, 0)});
  tiny.expect(100);
  for (int i = 0; i < 4; ++i) {
    const auto point = tiny.next_point();
    REQUIRE(point);
    tiny.insert(*point, kFlat(point->x, point->y));
  }
  tiny.paint({0, 0, 1, 1}, pixels);
  CHECK(pixels.colors == std::vector{Color(0.25F, 0.5F, 0.75F)});
}

// Regions of an image of tiles of 16 pixels.

constexpr int kTileSide = 16;

// The tiles left of a pixel column, or the others.
Region part_of_image(int column, bool is_left) {
  const TileGrid grid{kWidth, kHeight, kTileSide};
  std::vector<std::uint8_t> owned(static_cast<std::size_t>(grid.tile_count()));
  for (int tile = 0; tile < grid.tile_count(); ++tile)
    owned[static_cast<std::size_t>(tile)] = (grid.pixels(tile).x0 < column) == is_left ? 1 : 0;
  return Region(grid, owned);
}

// Samples until nothing is worth a sample, or so many. Returns the points.
std::vector<Vec2d> sample_all(LatticeRefiner& sampler, const Scene& scene, int most = 100'000) {
  return sample(sampler, scene, most);
}

TEST_CASE("lattice sampler: a region samples its own nodes, and the corners of its own squares") {
  constexpr int kColumn = 48;
  const Scene scene = disc(true);
  for (const bool is_left : {true, false}) {
    LatticeRefiner sampler(part_of_image(kColumn, is_left), shapes_of_disc(0));
    const std::size_t base = sampler.base_points().size();
    CHECK(base == static_cast<std::size_t>(is_left ? 7 * 9 : 8 * 9));
    const std::vector<Vec2d> points = sample_all(sampler, scene, 1500);
    REQUIRE(points.size() == 1500);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool lies_left = points[i].x < kColumn;
      // The corners on the border are sampled on both sides.
      if (i >= base) REQUIRE(lies_left == is_left);
      if (i < base) REQUIRE((lies_left == is_left || points[i].x == kColumn));
    }
  }
}

TEST_CASE("lattice sampler: two regions that tell each other of their border show one picture") {
  constexpr int kColumn = 48;
  const Scene scene = disc(true);
  LatticeRefiner left(part_of_image(kColumn, true), shapes_of_disc(0));
  LatticeRefiner right(part_of_image(kColumn, false), shapes_of_disc(0));
  const std::vector<Vec2d> of_left = sample_all(left, scene), of_right = sample_all(right, scene);
  const PixelBlock alone = painted(left, {0, 0, kColumn, kHeight});
  // Half a square beyond the border, and what lies on it.
  for (const Vec2d& p : of_left)
    if (p.x >= kColumn - 4) right.insert(p, scene(p.x, p.y));
  std::size_t told = 0;
  for (const Vec2d& p : of_right)
    if (p.x <= kColumn + 4) told += left.insert(p, scene(p.x, p.y)) ? 1U : 0U;
  CHECK(told > 50);
  const PixelBlock whole = painted(left, {0, 0, kColumn, kHeight});
  CHECK(whole.colors != alone.colors);  // the control: it matters
  LatticeRefiner together(Region::whole({kWidth, kHeight, kTileSide}), shapes_of_disc(0));
  for (const std::vector<Vec2d>* points : {&of_left, &of_right})
    for (const Vec2d& p : *points) together.insert(p, scene(p.x, p.y));
  const PixelBlock reference = painted(together, {0, 0, kColumn, kHeight});
  for (std::size_t i = 0; i < reference.colors.size(); ++i)
    REQUIRE((whole.colors[i] - reference.colors[i]).length() < 0.03F);  // edges learn different shares
}

// Nothing has come from beyond the border yet: the neighbour may be late.
TEST_CASE("lattice sampler: one colour stays one colour up to a border beyond which nothing is known") {
  constexpr int kColumn = 48;
  for (int samples = 63; samples < 600; samples += 50) {
    LatticeRefiner left(part_of_image(kColumn, true), kNoShapes);
    for (int i = 0; i < samples; ++i) {
      const auto point = left.next_point();
      REQUIRE(point);
      left.insert(*point, kFlat(point->x, point->y));
    }
    INFO(samples << " samples");
    for (const Color& color : painted(left, {0, 0, kColumn, kHeight}).colors)
      REQUIRE((color - Color(0.25F, 0.5F, 0.75F)).length() < 1e-5F);
  }
}

// Squares are black without their corners.
TEST_CASE("lattice sampler: a region that grows samples the corners of its new squares before it goes on") {
  constexpr int kGoesOn = 100;  // with the level that it is at, in one tile
  const Scene scene = disc(true);
  for (int before = 100; before < 900; before += 100) {
    LatticeRefiner sampler(part_of_image(48, true), shapes_of_disc(0));
    sample(sampler, scene, before);
    sampler.set_region(Region::whole({kWidth, kHeight, kTileSide}));
    sample(sampler, scene, kBase - 7 * 9 + kGoesOn);
    for (const Color& color : painted(sampler).colors) REQUIRE(color.length() > 0.05F);
    INFO(before << " samples");
    for (const Vec2d& corner : sampler.base_points())
      CHECK_FALSE(sampler.insert(corner, scene(corner.x, corner.y)));
  }
}

TEST_CASE("lattice sampler: a sample at no node, or at one that has a sample, is refused") {
  LatticeRefiner sampler(part_of_image(48, true), kNoShapes);
  CHECK(sampler.insert({8, 8}, kFlat(8, 8)));
  CHECK_FALSE(sampler.insert({8, 8}, kFlat(8, 8)));
  CHECK_FALSE(sampler.insert({8.1, 8}, kFlat(8, 8)));
  CHECK_FALSE(sampler.insert({kWidth + 20.0, 8}, kFlat(8, 8)));
  CHECK_FALSE(sampler.insert({-1, 8}, kFlat(8, 8)));
  CHECK(sampler.samples() == 1);
}

TEST_CASE("lattice sampler: squares that come are refined, squares that go are not, and sampling ends") {
  const Scene scene = disc(true);
  LatticeRefiner sampler(part_of_image(48, true), shapes_of_disc(0));
  sample_all(sampler, scene, 800);
  sampler.set_region(part_of_image(48, false));
  const std::vector<Vec2d> after = sample_all(sampler, scene);
  CHECK(after.size() > 500);
  CHECK(std::all_of(after.begin(), after.end(), [](const Vec2d& p) { return p.x >= 48; }));
  CHECK_FALSE(sampler.next_point());

  // Back again: the left part goes on where it was left, with what it knows.
  sampler.set_region(part_of_image(48, true));
  const std::vector<Vec2d> back = sample_all(sampler, scene);
  CHECK(back.size() > 500);
  CHECK(std::all_of(back.begin(), back.end(), [](const Vec2d& p) { return p.x < 48; }));
  CHECK(error_of(painted(sampler), scene) < 0.02);
}

TEST_CASE("lattice sampler: weights are sums over the region's candidates, and fall") {
  const Scene scene = disc(true);
  LatticeRefiner sampler(part_of_image(48, true), shapes_of_disc(0));
  std::vector<TileWeights> weights;
  double last = 0;
  for (const int samples : {100, 400, 1200}) {
    sample_all(sampler, scene, samples);
    sampler.weigh(weights);
    double sum = 0;
    std::int64_t count = 0;
    for (int tile = 0; tile < static_cast<int>(weights.size()); ++tile) {
      const TileWeights& w = weights[static_cast<std::size_t>(tile)];
      if (!sampler.region().owns_tile(tile)) CHECK(w.count == 0);
      sum += w.total_weight, count += w.count;
    }
    REQUIRE(count > 0);
    const double mean = sum / static_cast<double>(count);
    if (last > 0) CHECK(mean < 0.7 * last);
    last = mean;
  }
}

TEST_CASE("lattice sampler: level by level, each level is whole before the next begins") {
  LatticeRefiner sampler(Region::whole({kWidth, kHeight, kTileSide}), kNoShapes, LatticeOrder::kLevels);
  const std::vector<Vec2d> points = sample_all(sampler, disc(true), 2'000'000);
  CHECK(points.size() > std::size_t{kPixelSide} * kPixelSide * kWidth * kHeight);  // every node
  std::size_t level = 0;
  const std::size_t base = sampler.base_points().size();
  for (std::size_t i = base; i < points.size(); ++i) {
    const LatticeNode node = node_at(points[i]);
    std::size_t of_node = 0;
    while (!(kLatticeLevels[of_node] == level_of(node))) ++of_node;
    REQUIRE(of_node >= level);
    level = of_node;
  }
  CHECK(level == kLatticeLevels.size() - 1);
  CHECK_FALSE(sampler.next_point());
}

TEST_CASE("lattice sampler: what is like the picture before is refined evenly, not from the top down") {
  // A fine pattern on the left, hardly a change on the right; all rows are alike.
  const int side = GENERATE(256, 360), samples = side * side * 11 / 16;
  const Scene scene = of_color([side](double x, double y) {
    const double height = x < side / 2.0 ? 0.4 : 0.02;
    const double wave = std::sin(1.9 * x + std::sin(0.7 * y)) * std::sin(2.3 * y + std::sin(0.9 * x));
    return Color(static_cast<float>(0.5 + height * wave), 0.5F, 0.5F);
  });
  LatticeRefiner sampler(Region::whole({side, side, 32}), kNoShapes);
  const auto samples_of_frame = [&] {
    std::array<int, 2> in_half{};
    for (int i = 0; i < samples; ++i) {
      const auto point = sampler.next_point();
      if (!point) break;
      ++in_half[point->y < side / 2.0 ? 0 : 1];
      sampler.insert(*point, scene(point->x, point->y));
    }
    return in_half;
  };
  for (int frame = 0; frame < 6; ++frame) {
    const std::array<int, 2> in_half = samples_of_frame();
    INFO("frame " << frame << ": " << in_half[0] << " samples above, " << in_half[1] << " below");
    CHECK(in_half[0] + in_half[1] == samples);
    CHECK(in_half[0] < 1.2 * in_half[1]);
    CHECK(in_half[1] < 1.2 * in_half[0]);
    sampler.restart();
  }
}

TEST_CASE("lattice sampler: of an empty picture a few nodes of a level tell that there is nothing") {
  // A disc on a twentieth of the picture. The grid has 2,116 nodes; between them are 2,025 centres.
  constexpr int kSide = 360, kSamples = 8000;
  const auto is_near = [](const Vec2d& at) { return std::hypot(at.x - 180, at.y - 180) < 60; };
  const Scene disc = of_color([](double x, double y) {
    const double away = std::hypot(x - 180, y - 180),
                 shown = away < 45 ? 0.6 + 0.3 * std::sin(x) * std::sin(y) : 0.2;
    return Color(static_cast<float>(shown), 0.5F, 0.5F);
  });
  LatticeRefiner sampler(Region::whole({kSide, kSide, 32}), kNoShapes);
  sampler.expect(kSamples);
  int near = 0, all = 0;
  for (; all < kSamples; ++all) {
    const auto point = sampler.next_point();
    if (!point) break;
    near += is_near(*point) ? 1 : 0;
    sampler.insert(*point, disc(point->x, point->y));
  }
  INFO(near << " of " << all << " samples lie near the disc");
  CHECK(all == kSamples);
  CHECK(all - near < 3000);
}

TEST_CASE("lattice sampler: a surprise on a square's side makes the centre beyond it worth more") {
  // Stripes up to a line of base squares, beyond which all is flat: there centres wait.
  constexpr int kLine = 24, kBasePixels = kBaseSide / kPixelSide;
  const Scene scene = of_color([](double x, double y) {
    const bool is_bright = x < kLine - 1 && std::fmod(y, 2 * kBasePixels) < kBasePixels;
    return is_bright ? Color(0.9F, 0.9F, 0.9F) : Color(0.3F, 0.3F, 0.3F);
  });
  const TileGrid grid{64, 64, kBasePixels};
  LatticeRefiner sampler(Region::whole(grid), kNoShapes);
  std::optional<Vec2d> middle;
  std::set<std::pair<double, double>> sampled;
  for (int i = 0; i < 300 && !middle; ++i) {
    sampler.expect(300 - i);
    const auto point = sampler.next_point();
    REQUIRE(point);
    if (point->x == kLine && !is_base(node_at(*point)) && level_of(node_at(*point)).side == kBaseSide) {
      middle = point;
      continue;
    }
    sampler.insert(*point, scene(point->x, point->y));
    sampled.insert({point->x, point->y});
  }
  REQUIRE(middle);
  constexpr double kHalf = kBasePixels / 2.0;
  REQUIRE(sampled.count({kLine - kHalf, middle->y}) == 1);
  REQUIRE(sampled.count({kLine + kHalf, middle->y}) == 0);
  std::vector<TileWeights> before, after;
  sampler.weigh(before);
  sampler.insert(*middle, of_color([](double, double) { return Color(1, 1, 1); })(0, 0));
  sampler.weigh(after);
  const auto gain = [&](double x) {
    const auto tile = static_cast<std::size_t>(grid.tile_at(x, middle->y));
    return after[tile].total_weight - before[tile].total_weight;
  };
  // Two centres of smaller squares on either side; and beyond, where none is sampled, that of the square.
  CHECK(gain(kLine - kHalf) > 0);
  CHECK(gain(kLine + kHalf) > 1.2 * gain(kLine - kHalf));
}

}  // namespace pprt::lattice_refiner_test
