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
      {{traits_of(SamplerChoice::kDelaunay).work, 705, 580},
       {traits_of(SamplerChoice::kAuto).work, 370, 200}}));  // docs/decisions/0006-work-clock.md
  CostEstimator costs(grid, work);
  costs.begin_frame(true, FrameLikeness::kUnknown);
  costs.add_own(sample_at(2, 3));
  costs.add_own(sample_at(4, 1));
  costs.add_own(sample_at(12, 0));
  costs.add_received();
  CHECK(costs.now(0).cost == 4 * 110 + 2 * own);
  CHECK(costs.now(1).cost == own);
  const std::vector<TileReport> report = costs.report({region, weights, 3});
  REQUIRE(report.size() == 2);
  for (const TileReport& tile : report) CHECK(tile.preparation == received / 2);
}

TEST_CASE("cost estimator: a tile that comes brings what it cost in this frame and in the one before") {
  const TileGrid grid(20, 10, 10);
  CostEstimator costs(grid, traits_of(SamplerChoice::kAuto).work);
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
  CostEstimator costs(grid, traits_of(SamplerChoice::kAuto).work);
  costs.begin_frame(true, FrameLikeness::kUnknown);
  for (const double x : {2, 12}) costs.add_own(sample_at(x, 3));
  const RegionQuality refined{region, weights, 4};
  costs.update(refined, 1);
  const double paid = costs.now(0).cost, pixels = reconstruction_cost(grid, 0);
  REQUIRE(paid > 0);
  CHECK(costs.future_cost(refined, 0, 1) == Approx(3 * paid + pixels));
  CHECK(costs.future_cost(refined, 0, 4) == Approx(pixels));
  CHECK(costs.future_cost(refined, 0, 8) == Approx(-0.5 * paid + pixels));
}

}  // namespace
}  // namespace pprt::cost_estimator_test
