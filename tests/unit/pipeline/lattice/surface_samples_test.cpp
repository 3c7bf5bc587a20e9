// Samples by surface and square: which of them is found, by hand.
#include "pipeline/lattice/surface_samples.h"

#include <catch2/catch.hpp>

#include "pipeline/lattice/unsampled_surfaces.h"

namespace pprt::surface_samples_test {
namespace {

constexpr int kSquares = 5;  // in a row, and rows
constexpr int kSide = kSquares * kBaseSide;

NodeValue value(std::uint32_t surface, float red = 0) {
  return NodeValue(float4{red, 0, 0, 0}, surface);
}

// The node at (x, y) of a square, each in [0, kBaseSide).
LatticeNode node_in(int column, int row, int x, int y) {
  return {kBaseSide * column + x, kBaseSide * row + y};
}

}  // namespace

TEST_CASE("surface samples: a sample in the node's own square comes before nearer ones beside it") {
  SurfaceSamples samples(kSide, kSide);
  samples.add(node_in(2, 2, 0, 0), value(7, 0.25F));
  samples.add(node_in(3, 2, 0, 120), value(7, 0.5F));
  const SurfaceSamples::Known* found = samples.nearest(node_in(2, 2, 120, 120), 7);
  REQUIRE(found != nullptr);
  CHECK((found->node == node_in(2, 2, 0, 0) && found->value.channels()[0] == 0.25F));
  CHECK(samples.nearest(node_in(2, 2, 120, 120), 8) == nullptr);
}

TEST_CASE(
    "surface samples: without one there the nearest of the eight squares around is found, none beyond") {
  for (int row = 0; row < kSquares; ++row) {
    for (int column = 0; column < kSquares; ++column) {
      SurfaceSamples samples(kSide, kSide);
      samples.add(node_in(column, row, 40, 40), value(7));
      samples.add(node_in(column, row, 40, 40), value(1));
      const bool is_near = std::abs(column - 2) <= 1 && std::abs(row - 2) <= 1;
      INFO("square " << column << ", " << row);
      CHECK((samples.nearest(node_in(2, 2, 40, 40), 7) != nullptr) == is_near);
      CHECK(samples.has(node_in(2, 2, 0, 0), 7) == (column == 2 && row == 2));
    }
  }
  SurfaceSamples samples(kSide, kSide);
  samples.add(node_in(1, 2, 10, 64), value(7));
  samples.add(node_in(3, 2, 100, 64), value(7));
  samples.add(node_in(2, 1, 64, 20), value(7));
  samples.add(node_in(2, 3, 64, 90), value(7));
  CHECK(samples.nearest(node_in(2, 2, 8, 64), 7)->node == node_in(1, 2, 10, 64));
  CHECK(samples.nearest(node_in(2, 2, 120, 64), 7)->node == node_in(3, 2, 100, 64));
  CHECK(samples.nearest(node_in(2, 2, 64, 8), 7)->node == node_in(2, 1, 64, 20));
  CHECK(samples.nearest(node_in(2, 2, 64, 120), 7)->node == node_in(2, 3, 64, 90));
}

TEST_CASE("surface samples: squares at the borders have no neighbours across the picture") {
  SurfaceSamples samples(kSide, kSide);
  samples.add(node_in(4, 1, 64, 64), value(7));
  CHECK(samples.nearest(node_in(0, 2, 0, 0), 7) == nullptr);
  CHECK(samples.nearest(node_in(0, 1, 0, 0), 7) == nullptr);
  samples.add({kSide, kSide}, value(8));  // the last corner
  CHECK(samples.nearest({kSide, kSide}, 8) != nullptr);
  CHECK(samples.nearest({kSide - 1, kSide - 1}, 8) != nullptr);
}

TEST_CASE("surface samples: a square keeps the first two of each surface, and none after clear()") {
  SurfaceSamples samples(kSide, kSide);
  for (const int x : {0, 32, 64, 96}) samples.add(node_in(1, 1, x, 0), value(7));
  CHECK(samples.nearest(node_in(1, 1, 100, 0), 7)->node == node_in(1, 1, 32, 0));
  CHECK(samples.nearest(node_in(1, 1, 10, 0), 7)->node == node_in(1, 1, 0, 0));
  samples.add(node_in(1, 1, 96, 0), value(8));
  samples.add(node_in(2, 1, 0, 0), value(7));
  CHECK(samples.has(node_in(1, 1, 0, 0), 8));
  CHECK(samples.has(node_in(2, 1, 0, 0), 7));
  samples.clear();
  CHECK_FALSE(samples.has(node_in(1, 1, 0, 0), 7));
  CHECK(samples.nearest(node_in(1, 1, 0, 0), 7) == nullptr);
}

TEST_CASE(
    "unsampled surfaces: a tile gives those of a priority at least, and the others wait for their turn") {
  UnsampledSurfaces kept(2);
  const auto keep = [&](int tile, std::uint32_t surface, NodeState priority) {
    kept.keep(tile, {.node = {}, .surface = surface, .priority = priority});
  };
  keep(0, 1, 10), keep(0, 2, 20), keep(1, 3, 20), keep(0, 4, 30);
  const auto counts = [&] {
    return std::vector<std::int64_t>{kept.counts()[10], kept.counts()[20], kept.counts()[30]};
  };
  CHECK(counts() == std::vector<std::int64_t>{1, 2, 1});
  std::vector<UnsampledSurface> taken;
  kept.take(0, 20, taken);
  REQUIRE(taken.size() == 2);
  CHECK((taken[0].surface == 2 && taken[1].surface == 4));
  CHECK(counts() == std::vector<std::int64_t>{1, 1, 0});
  kept.take(0, 11, taken);
  CHECK(taken.size() == 2);
  kept.take(1, 20, taken);
  CHECK((taken.size() == 3 && taken[2].surface == 3));
  int left = 0;
  kept.for_each([&](const UnsampledSurface& surface) { left += surface.surface == 1 ? 1 : 100; });
  CHECK(left == 1);
  kept.clear();
  CHECK(counts() == std::vector<std::int64_t>{0, 0, 0});
  kept.take(0, kLeastCandidate, taken);
  CHECK(taken.size() == 3);
}

}  // namespace pprt::surface_samples_test
