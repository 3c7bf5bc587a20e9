#include "pipeline/lattice/lattice_region.h"

namespace pprt {

LatticeRegion::LatticeRegion(const LatticeStore& store, const Region& region)
    : region_(region),
      columns_(store.right() / kBaseSide),
      rows_(store.bottom() / kBaseSide),
      owned_(square_of({store.right(), store.bottom()}) + 1, 0),
      touched_(static_cast<std::size_t>(store.tile_count()), 0) {
  for (int y = 0; y < store.bottom(); y += kBaseSide) {
    for (int x = 0; x < store.right(); x += kBaseSide) {
      const Vec2d corner = point_of({x, y});
      if (!region.owns_point(corner.x, corner.y)) continue;
      owned_[square_of({x, y})] = 1;
      for (const int v : {y, y + kBaseSide}) {
        for (const int u : {x, x + kBaseSide}) touched_[static_cast<std::size_t>(store.tile_at({u, v}))] = 1;
      }
    }
  }
}

bool LatticeRegion::needs_base(const LatticeNode& corner) const {
  const auto [x, y] = corner;
  return owns_square(x, y) || owns_square(x - kBaseSide, y) || owns_square(x, y - kBaseSide) ||
         owns_square(x - kBaseSide, y - kBaseSide);
}

std::vector<LatticeNode> LatticeRegion::base_nodes() const {
  std::vector<LatticeNode> nodes;
  for (int y = 0; y <= rows_; ++y) {
    for (int x = 0; x <= columns_; ++x) {
      const LatticeNode node{kBaseSide * x, kBaseSide * y};
      if (needs_base(node)) nodes.push_back(node);
    }
  }
  return nodes;
}

}  // namespace pprt
