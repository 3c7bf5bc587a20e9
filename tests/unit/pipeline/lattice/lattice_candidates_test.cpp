// Which nodes a sample makes candidates, square by square.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "pipeline/lattice/lattice_refiner.h"

namespace pprt::lattice_candidates_test {
namespace {

// The candidates of each of nine base squares when there is one sample, at this node. A border belongs to the
// square right of it or below.
std::vector<std::int64_t> candidates_around(const LatticeNode& node) {
  constexpr int kBasePixels = kBaseSide / kPixelSide, kSize = 3 * kBasePixels;
  LatticeRefiner refiner(Region::whole({kSize, kSize, kBasePixels}), {});
  REQUIRE(refiner.insert(point_of(node), RaySample()));
  std::vector<TileWeights> weights;
  refiner.weigh(weights);
  std::vector<std::int64_t> counts;
  for (const TileWeights& tile : weights) counts.push_back(tile.count);
  return counts;
}

}  // namespace

TEST_CASE("lattice candidates: a sample at a centre asks for the middles of all four sides") {
  using Counts = std::vector<std::int64_t>;
  CHECK(candidates_around({192, 192}) == Counts{0, 0, 0, 0, 2, 1, 0, 1, 0});
  CHECK(candidates_around({160, 160}) == Counts{0, 0, 0, 0, 4, 0, 0, 0, 0});
}

TEST_CASE("lattice candidates: a sample in the middle of a side asks for the four centres around it") {
  using Counts = std::vector<std::int64_t>;
  CHECK(candidates_around({192, 128}) == Counts{0, 2, 0, 0, 2, 0, 0, 0, 0});
  CHECK(candidates_around({128, 192}) == Counts{0, 0, 0, 2, 2, 0, 0, 0, 0});
}

TEST_CASE("lattice candidates: where squares below a pixel are flat they come late, even near an edge") {
  constexpr int kSize = 64;
  constexpr double kEdge = 30.3;
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}), {});
  int at_edge = 0, beside_it = 0;
  for (int i = 0; i < 6000; ++i) {
    refiner.expect(6000 - i);
    const auto at = refiner.next_point();
    REQUIRE(at);
    RaySample seen;
    seen.primitive = 1;
    seen.color = at->x < kEdge ? Color(0.2F, 0.2F, 0.2F) : Color(0.8F, 0.8F, 0.8F);
    REQUIRE(refiner.insert(*at, seen));
    const LatticeNode node = node_at(*at);
    if (is_base(node) || level_of(node).side > kPixelSide) continue;
    ++(std::abs(at->x - kEdge) < 1 ? at_edge : beside_it);
  }
  CHECK((beside_it > 0.1 * at_edge &&
         beside_it < 0.2 * at_edge));  // they come, for something thin may be there
}

// What lies in a square that comes is known from others: the more it differs, the more is expected there.
TEST_CASE("lattice candidates: in a square that comes more is expected where samples around one differ") {
  constexpr int kBasePixels = kBaseSide / kPixelSide, kSize = 2 * kBasePixels;
  const TileGrid grid{kSize, kSize, kBasePixels};
  const auto expected = [&](float difference) {
    LatticeRefiner refiner(Region(grid, {0, 0, 0, 1}), {});
    RaySample seen;
    seen.primitive = 1;
    for (int y = 0; y <= kSize; y += kBasePixels) {
      for (int x = 0; x <= kSize; x += kBasePixels) {
        const float color = 0.5F + (x % (2 * kBasePixels) == 0 ? difference : -difference);
        seen.color = Color(color, color, color);
        REQUIRE(refiner.insert({x + 0.0, y + 0.0}, seen));
      }
    }
    seen.color = Color(0.5F, 0.5F, 0.5F);  // as predicted
    REQUIRE(refiner.insert({kBasePixels / 2.0, kBasePixels / 2.0}, seen));
    refiner.set_region(Region(grid, {1, 0, 0, 1}));
    std::vector<TileWeights> weights;
    refiner.weigh(weights);
    return weights[0].total_weight;
  };
  REQUIRE(expected(0) > 0);
  CHECK(expected(0.25F) > 1.1 * expected(0));
}

}  // namespace pprt::lattice_candidates_test
