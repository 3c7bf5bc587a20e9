// Which squares and corners of the lattice a ragged region has: against a search through all of them.
#include "pipeline/lattice/lattice_region.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace pprt::lattice_region_test {
namespace {

// The last tiles and base squares reach beyond the image: 9 x 7 squares of 8 pixels, four or fewer a tile.
constexpr int kWidth = 70, kHeight = 52, kColumns = 9, kRows = 7;
const TileGrid kGrid{kWidth, kHeight, 16};

// Tiles that touch at sides, at corners, and at each of the image's borders.
Region ragged(const std::set<int>& tiles) {
  std::vector<std::uint8_t> owned(static_cast<std::size_t>(kGrid.tile_count()), 0);
  for (const int tile : tiles) owned[static_cast<std::size_t>(tile)] = 1;
  return Region(kGrid, owned);
}

const std::vector<std::set<int>> kTiles = {{0, 6, 7, 12, 18}, {4, 9, 15, 19}, {10, 2}, {7}, {}};

using Square = std::pair<int, int>;  // column and row

std::set<Square> squares_of(const std::set<int>& tiles) {
  std::set<Square> squares;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column)
      if (tiles.contains(row / 2 * 5 + column / 2)) squares.emplace(column, row);
  }
  return squares;
}

LatticeNode corner_at(int column, int row) {
  return {kBaseSide * column, kBaseSide * row};
}

}  // namespace

TEST_CASE("lattice region: a node belongs to the square right of it and below, at the last borders before") {
  const LatticeStore store(kWidth, kHeight);
  REQUIRE((store.right() == kBaseSide * kColumns && store.bottom() == kBaseSide * kRows));
  for (const std::set<int>& tiles : kTiles) {
    const LatticeRegion region(store, ragged(tiles));
    const std::set<Square> squares = squares_of(tiles);
    for (int y = 0; y <= store.bottom(); y += kBaseSide / 4) {
      for (int x = 0; x <= store.right(); x += kBaseSide / 4) {
        const Square square(std::min(x / kBaseSide, kColumns - 1), std::min(y / kBaseSide, kRows - 1));
        INFO("node " << x << ", " << y);
        REQUIRE(region.owns({x, y}) == squares.contains(square));
      }
    }
  }
}

TEST_CASE("lattice region: the corners that it needs are those of its squares, and none beyond the lattice") {
  const LatticeStore store(kWidth, kHeight);
  for (const std::set<int>& tiles : kTiles) {
    const LatticeRegion region(store, ragged(tiles));
    const std::set<Square> squares = squares_of(tiles);
    std::vector<LatticeNode> needed;
    for (int row = -2; row <= kRows + 2; ++row) {
      for (int column = -2; column <= kColumns + 2; ++column) {
        const bool is_one = squares.contains({column, row}) || squares.contains({column - 1, row}) ||
                            squares.contains({column, row - 1}) || squares.contains({column - 1, row - 1});
        INFO("corner " << column << ", " << row);
        REQUIRE(region.needs_base(corner_at(column, row)) == is_one);
        if (is_one) needed.push_back(corner_at(column, row));
      }
    }
    CHECK(region.base_nodes() == needed);
  }
}

TEST_CASE("lattice region: it touches the tiles of the store that hold nodes of its squares") {
  const LatticeStore store(kWidth, kHeight);
  for (const std::set<int>& tiles : kTiles) {
    const LatticeRegion region(store, ragged(tiles));
    std::set<int> touched;
    for (const auto& [column, row] : squares_of(tiles)) {
      for (const int x : {column, column + 1})
        for (const int y : {row, row + 1}) touched.insert(store.tile_at(corner_at(x, y)));
    }
    for (int tile = 0; tile < store.tile_count(); ++tile)
      CHECK(region.touches_tile(tile) == touched.contains(tile));
  }
}

TEST_CASE("lattice region: what changes are the squares that one of two regions has alone") {
  const LatticeStore store(kWidth, kHeight);
  for (const std::set<int>& before : kTiles) {
    for (const std::set<int>& after : kTiles) {
      const std::set<Square> had = squares_of(before), has = squares_of(after);
      std::map<Square, bool> expected, found;
      for (const Square& square : had)
        if (!has.contains(square)) expected[square] = false;
      for (const Square& square : has)
        if (!had.contains(square)) expected[square] = true;
      const LatticeRegion now(store, ragged(after));
      now.for_each_change(LatticeRegion(store, ragged(before)), [&](const LatticeNode& corner, bool is_own) {
        found[{corner.x / kBaseSide, corner.y / kBaseSide}] = is_own;
      });
      CHECK(found == expected);
    }
  }
}

TEST_CASE("lattice region: level by level, squares that come are sampled at every node, too") {
  const TileGrid grid{16, 8, 8};
  LatticeRefiner refiner(Region(grid, {1, 0}), {}, LatticeOrder::kLevels);
  std::size_t sampled = 0;
  const auto sample_all = [&] {
    for (auto point = refiner.next_point(); point; point = refiner.next_point(), ++sampled)
      REQUIRE(refiner.insert(*point, RaySample()));
  };
  sample_all();
  CHECK((sampled > 128 * 128 && sampled < 130 * 130));
  refiner.set_region(Region::whole(grid));
  sample_all();
  CHECK(sampled == 256 * 128 + 16 + 8 + 1);  // on the last borders the corners of pixels only
}

}  // namespace pprt::lattice_region_test
