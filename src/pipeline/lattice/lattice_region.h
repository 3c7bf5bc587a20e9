// Which part of a lattice is a region's own: whole base squares.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/core/region.h"
#include "pipeline/lattice/lattice_store.h"

namespace pprt {

class LatticeRegion {
 public:
  // The region's tiles are whole base squares.
  LatticeRegion(const LatticeStore& store, const Region& region);

  const Region& region() const { return region_; }

  // Whether a node belongs to the region. Those on a border do to the square right of it or below.
  bool owns(const LatticeNode& node) const { return owned_[square_of(node)] != 0; }

  // Whether a tile of the store holds nodes of own squares, their borders included.
  bool touches_tile(int tile) const { return touched_[static_cast<std::size_t>(tile)] != 0; }

  // Whether a corner of base squares is one of an own square.
  bool needs_base(const LatticeNode& corner) const;

  // Returns these corners, row by row.
  std::vector<LatticeNode> base_nodes() const;

  // Calls visit(upper left corner, is own now) for each base square that the other region owns and this one
  // does not, or the other way round.
  template <class Visit>
  void for_each_change(const LatticeRegion& before, const Visit& visit) const;

 private:
  // The last column and row of nodes belong to the squares before them.
  std::size_t square_of(const LatticeNode& node) const;
  bool owns_square(int x, int y) const {
    return x >= 0 && y >= 0 && x < kBaseSide * columns_ && y < kBaseSide * rows_ && owns({x, y});
  }

  Region region_;
  int columns_, rows_;                 // of base squares
  std::vector<std::uint8_t> owned_;    // per base square
  std::vector<std::uint8_t> touched_;  // per tile of the store
};

inline std::size_t LatticeRegion::square_of(const LatticeNode& node) const {
  const int x = std::min(node.x / kBaseSide, columns_ - 1), y = std::min(node.y / kBaseSide, rows_ - 1);
  const int square = y * columns_ + x;
  return static_cast<std::size_t>(square);
}

template <class Visit>
void LatticeRegion::for_each_change(const LatticeRegion& before, const Visit& visit) const {
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      const LatticeNode corner{kBaseSide * x, kBaseSide * y};
      if (owns(corner) != before.owns(corner)) visit(corner, owns(corner));
    }
  }
}

}  // namespace pprt
