#include "parallel/balance/partition.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace pprt::partition_test {
namespace {

std::vector<double> uniform_costs(const TileGrid& grid) {
  return std::vector<double>(static_cast<std::size_t>(grid.tile_count()), 1.0);
}

// Costs over four orders of magnitude, a third of them nothing.
std::vector<double> wild_costs(const TileGrid& grid, unsigned seed) {
  std::mt19937 random(seed);
  std::lognormal_distribution<double> cost(0, 2);
  std::vector<double> costs;
  for (int i = 0; i < grid.tile_count(); ++i) costs.push_back(random() % 3 == 0 ? 0 : cost(random));
  return costs;
}

struct Holding {
  int x0 = 1 << 30, y0 = 1 << 30, x1 = 0, y1 = 0;  // tiles, half-open
  int tiles = 0;
  double cost = 0;
};

// What ranks [first, first + count) own together.
Holding holding(const Partition& partition, const std::vector<double>& costs, int first, int count) {
  Holding h;
  for (int t = 0; t < partition.grid.tile_count(); ++t) {
    const int owner = partition.owner[static_cast<std::size_t>(t)];
    if (owner < first || owner >= first + count) continue;
    const int x = t % partition.grid.columns(), y = t / partition.grid.columns();
    h.x0 = std::min(h.x0, x), h.x1 = std::max(h.x1, x + 1);
    h.y0 = std::min(h.y0, y), h.y1 = std::max(h.y1, y + 1);
    ++h.tiles;
    h.cost += costs[static_cast<std::size_t>(t)];
  }
  return h;
}

double dearest_line(const Partition& partition, const std::vector<double>& costs, const Holding& h) {
  const bool across_x = h.x1 - h.x0 >= h.y1 - h.y0;
  std::vector<double> lines(static_cast<std::size_t>(across_x ? h.x1 - h.x0 : h.y1 - h.y0), 0.0);
  for (int y = h.y0; y < h.y1; ++y) {
    for (int x = h.x0; x < h.x1; ++x) {
      lines[static_cast<std::size_t>(across_x ? x - h.x0 : y - h.y0)] +=
          costs[static_cast<std::size_t>(y * partition.grid.columns() + x)];
    }
  }
  return *std::max_element(lines.begin(), lines.end());
}

// Each cut of the recursion gives either side its share to within half the dearest tile line, where no side
// is so small that its ranks would go without a tile.
void check_cuts(const Partition& partition, const std::vector<double>& costs, int first, int ranks) {
  if (ranks == 1) return;
  const Holding all = holding(partition, costs, first, ranks);
  const int half = ranks / 2;
  const Holding left = holding(partition, costs, first, half);
  CHECK(std::abs(left.cost - all.cost * half / ranks) <=
        0.5 * dearest_line(partition, costs, all) + 1e-9 * all.cost);
  check_cuts(partition, costs, first, half);
  check_cuts(partition, costs, first + half, ranks - half);
}

void check_sound(const Partition& partition, int ranks) {
  const TileGrid& grid = partition.grid;
  REQUIRE(partition.owner.size() == static_cast<std::size_t>(grid.tile_count()));
  CHECK(partition.ranks == ranks);
  const auto [least, most] = std::minmax_element(partition.owner.begin(), partition.owner.end());
  CHECK((*least >= 0 && *most < ranks));
  const std::vector<double> costs = uniform_costs(grid);
  std::size_t pixels = 0;
  for (int rank = 0; rank < ranks; ++rank) {
    INFO("rank " << rank);
    CHECK(is_connected(partition, rank));
    const Holding h = holding(partition, costs, rank, 1);
    if (h.tiles > 0) CHECK(h.tiles == (h.x1 - h.x0) * (h.y1 - h.y0));  // a rectangle
    const Region region = region_of(partition, rank);
    CHECK(region.tiles().size() == static_cast<std::size_t>(h.tiles));
    pixels += region.pixel_count();
  }
  CHECK(pixels == static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
}

}  // namespace

TEST_CASE(
    "partition: every tile has one owner and every region is a rectangle, for any image and number of "
    "ranks") {
  for (const auto& [width, height] :
       {std::pair(1, 1), {5, 3}, {64, 64}, {640, 8}, {7, 500}, {320, 200}, {1001, 333}}) {
    for (int ranks = 1; ranks <= 64; ++ranks) {
      INFO(width << "x" << height << " on " << ranks << " ranks");
      const TileGrid grid = tile_grid_for(width, height, ranks);
      check_sound(bisect(grid, uniform_costs(grid), ranks), ranks);
      check_sound(bisect(grid, wild_costs(grid, static_cast<unsigned>(ranks)), ranks), ranks);
    }
  }
}

TEST_CASE("partition: ranks own what their speeds make equally long, and nothing without speed") {
  const TileGrid grid = tile_grid_for(640, 480, 8);
  const std::vector<double> speeds = {1, 0, 2, 4, 0, 1, 2, 2};
  const Partition partition = bisect(grid, uniform_costs(grid), speeds);
  for (int rank = 0; rank < 8; ++rank) {
    INFO("rank " << rank);
    const double share = static_cast<double>(region_of(partition, rank).tiles().size()) / grid.tile_count();
    CHECK(share == Approx(speeds[static_cast<std::size_t>(rank)] / 12).margin(0.02));
  }
  CHECK(region_of(partition, 1).tiles().empty());
  CHECK(region_of(partition, 4).tiles().empty());
}

TEST_CASE("partition: every cut of the bisection balances cost to within half a tile line") {
  for (const int ranks : {2, 3, 5, 8, 13, 32, 62}) {
    INFO(ranks << " ranks");
    const TileGrid grid = tile_grid_for(640, 480, ranks);
    const std::vector<double> even = uniform_costs(grid);
    check_cuts(bisect(grid, even, ranks), even, 0, ranks);
  }
  // Uneven costs on two ranks: one cut, never short of tiles.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const TileGrid grid(300, 200, 10);
    const std::vector<double> costs = wild_costs(grid, seed);
    check_cuts(bisect(grid, costs, 2), costs, 0, 2);
  }
}

TEST_CASE("partition: every rank has a tile when there are plenty") {
  for (const int ranks : {1, 2, 7, 31, 64}) {
    const TileGrid grid = tile_grid_for(512, 512, ranks);
    REQUIRE(grid.tile_count() >= 16 * ranks);
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Partition partition = bisect(grid, wild_costs(grid, seed), ranks);
      const std::set<int> owners(partition.owner.begin(), partition.owner.end());
      CHECK(owners.size() == static_cast<std::size_t>(ranks));
    }
  }
}

TEST_CASE("partition: in a row of tiles every rank has one, wherever the costs are") {
  constexpr int kTiles = 12;
  for (const auto& [width, height] : {std::pair(kTiles * 10, 10), std::pair(10, kTiles * 10)}) {
    const TileGrid grid(width, height, 10);
    for (std::size_t dear = 0; dear < kTiles; ++dear) {
      std::vector<double> costs = uniform_costs(grid);
      costs[dear] = 1000;
      for (int ranks = 2; ranks <= kTiles; ++ranks) {
        const Partition partition = bisect(grid, costs, ranks);
        INFO(ranks << " ranks, tile " << dear << " costs most, " << width << " pixels wide");
        CHECK(std::set<std::int32_t>(partition.owner.begin(), partition.owner.end()).size() ==
              static_cast<std::size_t>(ranks));
      }
    }
  }
}

TEST_CASE("partition: with more ranks than tiles some ranks have none") {
  const TileGrid grid(8, 8, 4);
  const Partition partition = bisect(grid, uniform_costs(grid), 9);
  check_sound(partition, 9);
  const std::set<int> owners(partition.owner.begin(), partition.owner.end());
  CHECK(owners.size() == 4);
  const Partition one_tile = bisect(TileGrid(3, 2, 4), std::vector<double>{5.0}, 64);
  check_sound(one_tile, 64);
}

TEST_CASE("partition: costs that are all zero count as equal") {
  const TileGrid grid(160, 160, 10);
  const std::vector<double> nothing(256, 0.0);
  CHECK(bisect(grid, nothing, 12).owner == bisect(grid, uniform_costs(grid), 12).owner);
}

TEST_CASE("partition: an expensive corner gets more ranks") {
  const TileGrid grid(160, 160, 10);
  std::vector<double> costs = uniform_costs(grid);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) costs[static_cast<std::size_t>(16 * y + x)] = 100;
  }
  const Partition partition = bisect(grid, costs, 16);
  std::set<int> in_corner;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) in_corner.insert(partition.owner[static_cast<std::size_t>(16 * y + x)]);
  }
  CHECK(in_corner.size() >= 8);  // it holds 87 % of the cost
}

TEST_CASE("partition: tiles are between 2 and 32 pixels wide, and about 100 a rank") {
  CHECK(tile_grid_for(4, 4, 64).tile_size == 2);
  CHECK(tile_grid_for(16384, 16384, 1).tile_size == 32);
  for (const int ranks : {1, 4, 16, 32}) {
    const TileGrid grid = tile_grid_for(512, 384, ranks);
    INFO(ranks << " ranks, tile size " << grid.tile_size);
    CHECK((grid.tile_size == 32 || grid.tile_count() < 150 * ranks));
    CHECK(grid.tile_count() >= 100 * ranks);
  }
}

TEST_CASE("partition: regions that touch at a corner only are not connected") {
  Partition partition{TileGrid(20, 20, 10), 2, {0, 1, 1, 0}, {0, 0, 0, 0}};
  CHECK_FALSE(is_connected(partition, 0));
  CHECK_FALSE(is_connected(partition, 1));
  partition.owner = {0, 0, 1, 0};
  CHECK(is_connected(partition, 0));
  CHECK(is_connected(partition, 1));
  partition.owner = {0, 0, 0, 0};
  CHECK(is_connected(partition, 1));  // an empty region
}

}  // namespace pprt::partition_test
