// Which nodes a sample makes candidates, square by square.
#include <catch2/catch.hpp>
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

}  // namespace pprt::lattice_candidates_test
