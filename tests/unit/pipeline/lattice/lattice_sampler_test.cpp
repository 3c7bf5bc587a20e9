// What the sampler on a lattice adds to its refiner: goals, weights that are kept for a while, the samples.
#include "pipeline/lattice/lattice_sampler.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::lattice_sampler_test {
namespace {

constexpr int kSize = 64;
const TileGrid kGrid{kSize, kSize, 16};

// A picture with detail everywhere.
Sample seen_at(const Vec2d& point) {
  Sample sample;
  sample.x = point.x, sample.y = point.y;
  sample.ray.color = Color(static_cast<float>(0.5 + 0.4 * std::sin(0.9 * point.x) * std::cos(1.3 * point.y)));
  sample.ray.primitive = 1;
  return sample;
}

// The tiles of these columns.
Region columns(int from, int to) {
  std::vector<std::uint8_t> owned;
  for (int tile = 0; tile < kGrid.tile_count(); ++tile)
    owned.push_back(tile % 4 >= from && tile % 4 < to ? 1 : 0);
  return Region(kGrid, owned);
}

template <class Refined>
std::vector<Vec2d> refine(Refined& refined, int count) {
  std::vector<Vec2d> points;
  for (int i = 0; i < count; ++i) {
    const std::optional<Vec2d> point = refined.next_point();
    REQUIRE(point);
    const Sample sample = seen_at(*point);
    if constexpr (std::is_same_v<Refined, LatticeSampler>) {
      REQUIRE(refined.insert(sample));
    } else {
      REQUIRE(refined.insert(*point, sample.ray));
    }
    points.push_back(*point);
  }
  return points;
}

LatticeSampler whole(bool keeps_samples = true) {
  return {Region::whole(kGrid), LatticeOrder::kAdaptive, {.keeps_samples = keeps_samples}, {}};
}

std::vector<std::int64_t> counts_of(const RegionQuality& quality) {
  std::vector<std::int64_t> counts;
  for (const TileWeights& weights : quality.tiles) counts.push_back(weights.count);
  return counts;
}

}  // namespace

TEST_CASE("lattice sampler: where so many times the samples are expected, as many as are lacking come") {
  const auto points_after = [](const auto& tell_sampler, const auto& tell_refiner) {
    LatticeSampler sampler = whole();
    LatticeRefiner refiner(Region::whole(kGrid), {});
    CHECK(refine(sampler, 200) == refine(refiner, 200));
    tell_sampler(sampler), tell_refiner(refiner);
    const std::vector<Vec2d> points = refine(sampler, 600);
    CHECK(points == refine(refiner, 600));
    return points;
  };
  const auto with_factor = [&](double factor) {
    return points_after([&](LatticeSampler& s) { s.expect_growth(factor); },
                        [&](LatticeRefiner& r) { r.expect(200 * (factor - 1)); });
  };
  CHECK(with_factor(4) != with_factor(20));
}

TEST_CASE("lattice sampler: weights are those of the refiner, until there are half as many samples again") {
  LatticeSampler sampler = whole();
  LatticeRefiner refiner(Region::whole(kGrid), {});
  const auto weights_now = [&] {
    std::vector<TileWeights> weights;
    refiner.weigh(weights);
    std::vector<std::int64_t> counts;
    for (const TileWeights& tile : weights) counts.push_back(tile.count);
    return counts;
  };
  refine(sampler, 400), refine(refiner, 400);
  const std::vector<std::int64_t> at_400 = counts_of(sampler.quality());
  CHECK(at_400 == weights_now());
  double weight = 0, count = 0;
  for (const TileWeights& tile : sampler.quality().tiles)
    weight += tile.total_weight, count += static_cast<double>(tile.count);
  CHECK(sampler.quality().mean_weight == Approx(weight / count));
  refine(sampler, 200), refine(refiner, 200);
  REQUIRE(weights_now() != at_400);
  CHECK(counts_of(sampler.quality()) == at_400);
  refine(sampler, 1), refine(refiner, 1);
  CHECK(counts_of(sampler.quality()) == weights_now());
  // A picture that is painted is weighed exactly.
  refine(sampler, 5), refine(refiner, 5);
  PixelBlock pixels;
  sampler.paint({}, pixels);
  CHECK(counts_of(sampler.quality()) == weights_now());
  sampler.clear(true);
  for (const std::int64_t tile : counts_of(sampler.quality())) CHECK(tile == 0);
}

TEST_CASE("lattice sampler: it is refined to what a sample is worth") {
  LatticeSampler sampler = whole();
  LatticeRefiner refiner(Region::whole(kGrid), {});
  std::vector<TileWeights> weights;
  refine(sampler, 400), refine(refiner, 400);
  const double worth = refiner.weigh(weights);
  REQUIRE(worth > 0);
  CHECK(sampler.is_refined_to(worth * 1.0001));
  CHECK_FALSE(sampler.is_refined_to(worth * 0.9999));
  // It weighs when it is expected to be refined, and a quarter later at the latest.
  const std::vector<std::int64_t> at_400 = counts_of(sampler.quality());
  const auto weighs_by = [&](std::size_t samples, double weight) {
    refine(sampler, samples), refine(refiner, samples);
    const bool is_refined = sampler.is_refined_to(weight);
    const bool is_weighed = counts_of(sampler.quality()) != at_400;
    CHECK(is_refined == (is_weighed && refiner.weigh(weights) <= weight));
    return is_weighed;
  };
  SECTION("what is far away") {
    CHECK_FALSE(weighs_by(100, 0.1 * worth));
    CHECK(weighs_by(1, 0.1 * worth));
  }
  SECTION("what is near: a sample's worth falls as the fourth power of their number") {
    const double near = worth / std::pow(1.06, 4);
    CHECK_FALSE(weighs_by(20, near));
    CHECK(weighs_by(5, near));
  }
  SECTION("what is nearer still is no reason to weigh after each round") {
    CHECK_FALSE(weighs_by(7, 0.9999 * worth));
    CHECK(weighs_by(2, 0.9999 * worth));
  }
}

TEST_CASE(
    "lattice sampler: a region that gets smaller keeps the weights of what is left, a larger one none") {
  LatticeSampler sampler = whole();
  refine(sampler, 500);
  const std::vector<std::int64_t> all = counts_of(sampler.quality());
  sampler.set_region(columns(1, 3));
  const RegionQuality left = sampler.quality();
  double weight = 0, count = 0;
  for (int tile = 0; tile < kGrid.tile_count(); ++tile) {
    const bool is_own = tile % 4 == 1 || tile % 4 == 2;
    INFO("tile " << tile);
    CHECK(left.tile(tile).count == (is_own ? all[static_cast<std::size_t>(tile)] : 0));
    weight += left.tile(tile).total_weight, count += static_cast<double>(left.tile(tile).count);
  }
  CHECK(left.mean_weight == Approx(weight / count));
  sampler.set_region(columns(1, 4));
  std::int64_t of_new = 0;
  for (const int row : {0, 1, 2, 3}) of_new += sampler.quality().tile(4 * row + 3).count;
  CHECK(of_new > 0);  // weighed anew
}

TEST_CASE("lattice sampler: a sample stands for the area of its node") {
  const LatticeSampler sampler = whole();
  CHECK(sampler.footprint({8, 16}) == 8);                          // a corner of base squares
  CHECK(sampler.footprint({4, 4}) == Approx(8 * std::sqrt(0.5)));  // a centre of one
  CHECK(sampler.footprint({4, 8}) == 4);                           // the middle of its side
  CHECK(sampler.footprint({8, 4}) == 4);
  CHECK(sampler.footprint({2, 2}) == Approx(4 * std::sqrt(0.5)));
  CHECK(sampler.footprint({0.5, 0.5}) == Approx(std::sqrt(0.5)));  // the centre of a pixel
  CHECK(sampler.footprint({1.0 / 16, 0}) == Approx(1.0 / 16));     // the finest
}

TEST_CASE("lattice sampler: a sample reaches as far as the square whose centre it is, and no other does") {
  const LatticeSampler sampler = whole();
  const auto reach = [&](double x, double y) { return sampler.reach(seen_at({x, y})); };
  CHECK(
      (reach(8, 16) == 0 && reach(4, 8) == 0 && reach(8, 4) == 0));  // a corner, and the middles of its sides
  CHECK((reach(4, 4) == 4 && reach(12, 20) == 4));
  CHECK((reach(2, 6) == 2 && reach(2, 4) == 0 && reach(0.5, 3.5) == 0.5));
}

TEST_CASE("lattice sampler: of a goal its region's share is expected, whatever the region becomes") {
  constexpr double kGoal = 2000;
  LatticeSampler sampler(columns(0, 4), LatticeOrder::kAdaptive, {.samples = 2000}, {});
  LatticeRefiner refiner(columns(0, 4), {});
  sampler.clear(false);
  refiner.clear();
  refiner.expect(kGoal);
  CHECK(refine(sampler, 300) == refine(refiner, 300));
  sampler.set_region(columns(1, 3));
  LatticeRefiner untold(columns(0, 4), {});
  untold.expect(kGoal);
  refine(untold, 300);
  for (LatticeRefiner* each : {&refiner, &untold}) each->set_region(columns(1, 3));
  refiner.expect(kGoal / 2 - 300);
  const std::vector<Vec2d> points = refine(sampler, 500);
  CHECK(points == refine(refiner, 500));
  CHECK(points != refine(untold, 500));
}

TEST_CASE("lattice sampler: samples are kept if somebody asks, and none after clear()") {
  for (const bool keeps : {true, false}) {
    LatticeSampler sampler = whole(keeps);
    refine(sampler, 100);
    CHECK_FALSE(sampler.insert(seen_at({0, 0})));
    CHECK(sampler.size() == 100);
    CHECK(sampler.samples().size() == (keeps ? 100 : 0));
    sampler.clear(true);
    CHECK((sampler.size() == 0 && sampler.samples().empty()));
  }
}

TEST_CASE("lattice sampler: seeds are the corners of base squares, own ones if they lie in the region") {
  LatticeSampler sampler(columns(1, 2), LatticeOrder::kAdaptive, {}, {});
  const std::vector<SeedPoint> seeds = sampler.seeds();
  REQUIRE(seeds.size() == 3 * 9);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    CHECK(seeds[i].number == i);
    CHECK(seeds[i].at == Vec2d(16 + 8.0 * static_cast<double>(i % 3), 8.0 * static_cast<double>(i / 3)));
    CHECK(seeds[i].own == (i % 3 < 2));
  }
  CHECK(sampler.missing_base().size() == seeds.size());
  sampler.insert(seen_at(seeds[4].at));
  CHECK(sampler.missing_base().size() == seeds.size() - 1);
}

TEST_CASE("lattice sampler: only lit samples of its region are cast, for the lights they know") {
  LatticeSampler sampler(columns(0, 2), LatticeOrder::kAdaptive, {}, {});
  Camera camera;
  camera.width = camera.height = kSize;
  camera.slope_per_pixel = 0.01;
  const auto put = [&](double x, std::uint8_t asked) {
    Sample sample = seen_at({x, 16});
    sample.ray.hit = Vec3f(ray_direction(camera, x, 16) * 5);
    sample.ray.lights = {asked, 0};
    sample.frame = 1;
    REQUIRE(sampler.insert(sample));
  };
  put(8, 1), put(16, 0), put(40, 1);
  const CastResult cast = sampler.cast(camera, 2, {.method = CastMethod::kVerified});
  REQUIRE(cast.samples.size() == 1);
  CHECK(cast.samples[0].x == Approx(8));
}

TEST_CASE("lattice sampler: tiles are painted one by one until the time is over") {
  LatticeSampler sampler = whole();
  refine(sampler, 300);
  PixelBlock pixels, again;
  sampler.paint({}, pixels);
  CHECK(pixels.bounds == PixelRect{0, 0, kSize, kSize});
  again = pixels;
  refine(sampler, 900);
  int asked = 0;
  const std::vector<std::int32_t> tiles = {5, 0, 15};
  CHECK(sampler.repaint(
            tiles, [&] { return ++asked == 2; }, again) == 2);
  CHECK(asked == 2);
  PixelBlock now;
  sampler.paint({}, now);
  for (const int tile : {5, 0, 15, 6}) {
    const PixelRect rect = kGrid.pixels(tile);
    const PixelBlock& expected = tile == 5 || tile == 0 ? now : pixels;
    INFO("tile " << tile);
    for (int y = rect.y0; y < rect.y1; ++y)
      for (int x = rect.x0; x < rect.x1; ++x) REQUIRE(again.at(x, y) == expected.at(x, y));
  }
}

}  // namespace pprt::lattice_sampler_test
