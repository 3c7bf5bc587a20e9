#include "parallel/balance/cost_estimator.h"

#include <array>
#include <catch2/catch.hpp>

#include "parallel/exchange/samplers.h"

namespace pprt::cost_estimator_test {
namespace {

Sample sample_at(double x, std::uint32_t rays) {
  Sample sample;
  sample.x = x;
  sample.y = 3;
  sample.ray.rays = rays;
  return sample;
}

TEST_CASE("cost estimator: a sample costs its tile its rays, and what its sampler does with it") {
  const TileGrid grid(20, 10, 10);
  const Region region = Region::whole(grid);
  const std::array<TileWeights, 2> weights{
      {{.total_weight = 4, .count = 1}, {.total_weight = 2, .count = 1}}};
  const auto [work, own, received] = GENERATE(table<SampleWork, double, double>(
      {{work_of(traits_of(SamplerChoice::kDelaunay)), 705, 580},
       {work_of(traits_of(SamplerChoice::kAuto)), 370, 200}}));  // docs/decisions/0006-work-clock.md
  CostEstimator costs(grid, work);
  costs.begin_frame(true, FrameLikeness::kUnknown);
  costs.add_own(sample_at(2, 3));
  costs.add_own(sample_at(4, 1));
  costs.add_own(sample_at(12, 0));
  costs.add_received();
  CHECK(costs.now(0).cost == 4 * 110 + 2 * own);
  CHECK(costs.now(1).cost == own);
  CHECK(costs.counted() == 4 * 110 + 3 * own + received);
  const std::vector<TileReport> report = costs.report({region, weights, 3});
  REQUIRE(report.size() == 2);
  for (const TileReport& tile : report) CHECK(tile.preparation == received / 2);
  // What was received is shared by the tiles of the region, be it one.
  const std::vector<TileReport> alone = costs.report({Region(grid, {0, 1}), weights, 2});
  REQUIRE(alone.size() == 1);
  CHECK((alone[0].tile == 1 && alone[0].preparation == received));
  // At least what a candidate costs in the mean.
  CHECK(report[0].cost == 4 * 110 + 2 * own);
  CHECK(report[1].cost == Approx((4 * 110 + 3 * own) / 2));
}

TEST_CASE("cost estimator: a tile that comes brings what it cost in this frame and in the one before") {
  const TileGrid grid(20, 10, 10);
  CostEstimator costs(grid, work_of(traits_of(SamplerChoice::kAuto)));
  costs.begin_frame(true, FrameLikeness::kSimilar);
  costs.accept(
      {.tile = 1, .now = {.cost = 10, .average_weight = 2}, .last = {.cost = 70, .average_weight = 3}});
  CHECK((costs.now(1).cost == 10 && costs.now(1).average_weight == 2));
  CHECK((costs.last(1).cost == 70 && costs.last(1).average_weight == 3));
  CHECK((costs.now(0).cost == 0 && costs.last(0).cost == 0));
}

TEST_CASE("cost estimator: a tile still costs what its target takes, less what has been paid") {
  const TileGrid grid(20, 10, 10);
  const Region region = Region::whole(grid);
  const std::array<TileWeights, 2> weights{
      {{.total_weight = 4, .count = 1}, {.total_weight = 4, .count = 1}}};
  CostEstimator costs(grid, work_of(traits_of(SamplerChoice::kAuto)));
  costs.begin_frame(true, FrameLikeness::kUnknown);
  for (int i = 0; i < 100; ++i) costs.add_own(sample_at(i % 2 == 0 ? 2 : 12, 3));
  const RegionQuality refined{region, weights, 4};
  costs.update(refined, 1);
  const double paid = costs.now(0).cost, pixels = reconstruction_cost(grid, 0);
  REQUIRE(paid > 0);
  CHECK(costs.future_cost(refined, 0, 1) == Approx(3 * paid + pixels));
  CHECK(costs.future_cost(refined, 0, 4) == Approx(pixels));
  REQUIRE(0.5 * paid > pixels);
  CHECK(costs.future_cost(refined, 0, 8) == Approx(-0.5 * paid + pixels));
  CHECK(costs.future_cost_of_region(refined, 8) == Approx(2 * (-0.5 * paid + pixels)));  // no bound at 0
}

TEST_CASE("cost estimator: pixels of several surfaces cost what they take in this frame") {
  const TileGrid grid(20, 10, 10);
  const Region region = Region::whole(grid);
  std::array<TileWeights, 2> weights{
      {{.total_weight = 4, .count = 1, .mixed_pixels = 7}, {.total_weight = 4, .count = 1}}};
  const RegionQuality refined{region, weights, 4};
  CostEstimator costs(grid, work_of(traits_of(SamplerChoice::kAuto)));
  costs.begin_frame(true, FrameLikeness::kUnknown, 1000);
  const double pixels = reconstruction_cost(grid, 0);
  CHECK(costs.future_cost(refined, 0, 1) == Approx(7000 + pixels));
  CHECK(costs.future_cost(refined, 1, 1) == Approx(pixels));
  CHECK(costs.future_cost_of_region(refined, 1) == Approx(7000 + 2 * pixels));
  const std::vector<TileReport> report = costs.report(refined);
  CHECK((report[0].preparation == 7000 && report[1].preparation == 0));
  costs.begin_frame(true, FrameLikeness::kUnknown);
  CHECK(costs.future_cost(refined, 0, 1) == Approx(pixels));
}

TEST_CASE("cost estimator: the frame before counts by its likeness, and gives way with the time") {
  const TileGrid grid(20, 10, 10);
  const Region region = Region::whole(grid);
  const std::array<TileWeights, 2> weights{
      {{.total_weight = 6, .count = 2}, {.total_weight = 3, .count = 1}}};  // mean 3
  const RegionQuality refined{region, weights, 3};
  const auto future = [&](FrameLikeness likeness, double elapsed) {
    CostEstimator costs(grid, work_of(traits_of(SamplerChoice::kAuto)));
    costs.begin_frame(true, likeness);
    costs.accept({.tile = 0, .now = {.cost = 1000}, .last = {.cost = 200, .average_weight = 5}});
    costs.accept({.tile = 1, .now = {.cost = 800}, .last = {}});
    costs.update(refined, elapsed);
    return costs.future_cost(refined, 0, 1) + 1000 - reconstruction_cost(grid, 0);
  };
  for (const double elapsed : {0.25, 1.0}) {
    CHECK(future(FrameLikeness::kUnknown, elapsed) == Approx(3 * 1200));  // two triangles' share of 1800
    CHECK(future(FrameLikeness::kSame, elapsed) == Approx(5 * 200));
    CHECK(future(FrameLikeness::kSimilar, elapsed) == Approx(elapsed * 3 * 1200 + (1 - elapsed) * 5 * 200));
  }
}

TEST_CASE("cost estimator: what received samples cost before is still to come, if the frames are alike") {
  const TileGrid grid(20, 10, 10);
  const Region region = Region::whole(grid);
  const std::array<TileWeights, 2> weights{
      {{.total_weight = 2, .count = 1}, {.total_weight = 2, .count = 1}}};
  const RegionQuality refined{region, weights, 2};
  const SampleWork work = work_of(traits_of(SamplerChoice::kAuto));
  for (const FrameLikeness likeness : {FrameLikeness::kSame, FrameLikeness::kUnknown}) {
    CostEstimator costs(grid, work);
    costs.begin_frame(true, FrameLikeness::kUnknown);
    for (int i = 0; i < 5; ++i) costs.add_received();
    costs.begin_frame(false, likeness);
    costs.update(refined, 0.5);
    const auto beside_tiles = [&] {
      return costs.future_cost_of_region(refined, 1) - costs.future_cost(refined, 0, 1) -
             costs.future_cost(refined, 1, 1);
    };
    const double each = likeness == FrameLikeness::kSame ? static_cast<double>(price(work.received)) : 0;
    CHECK(beside_tiles() == Approx(5 * each).margin(1e-6));
    for (int i = 0; i < 3; ++i) costs.add_received();
    CHECK(beside_tiles() == Approx(2 * each).margin(1e-6));
    for (int i = 0; i < 9; ++i) costs.add_received();
    CHECK(beside_tiles() == Approx(0).margin(1e-6));
  }
}

TEST_CASE("cost estimator: a new picture's tiles remember the last one's weights, those without any too") {
  const TileGrid grid(20, 10, 10);
  const Region region = Region::whole(grid);
  std::array<TileWeights, 2> weights{{{.total_weight = 6, .count = 2}, {.total_weight = 9, .count = 1}}};
  CostEstimator costs(grid, work_of(traits_of(SamplerChoice::kAuto)));
  costs.begin_frame(true, FrameLikeness::kUnknown);
  costs.add_own(sample_at(2, 3));
  costs.report({region, weights, 5});
  weights[1] = {};
  const std::vector<TileReport> report = costs.report({region, weights, 3});
  CHECK((report[1].triangles == 0 && report[1].total_weight == 0));
  const double paid = costs.now(0).cost;
  costs.begin_frame(true, FrameLikeness::kSimilar);
  CHECK((costs.last(0).average_weight == 3 && costs.last(0).cost == paid));
  CHECK(costs.last(1).average_weight == 9);
  CHECK((costs.now(0).cost == 0 && costs.now(0).average_weight == 0));
}

}  // namespace
}  // namespace pprt::cost_estimator_test
