#include "convert/model/closed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/disjoint_sets.h"

namespace pprt {
namespace {

constexpr double kCell = 1e-4;  // of the mesh's longest side: beyond rounding, below what is seen

using Cell = std::array<std::int32_t, 3>;

// Returns the cells of a grid that positions in range lie in; others are in one of their own. `shift`: of the
// grid, in cells.
std::vector<Cell> cells_of(const std::vector<Vec3d>& positions, double shift) {
  Box3d box;
  for (const Vec3d& p : positions) {
    if (is_in_range(p)) box.extendBy(p);
  }
  const Vec3d size = box.isEmpty() ? Vec3d(0, 0, 0) : box.size();
  const double scale = 1 / (kCell * std::max({size.x, size.y, size.z, 1e-200}));
  std::vector<Cell> cells(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!is_in_range(positions[i])) {
      cells[i] = {-1, static_cast<std::int32_t>(i & 0x7FFFFFFF), -1};
      continue;
    }
    const Vec3d p = (positions[i] - box.min) * scale;
    for (int k = 0; k < 3; ++k)
      cells[i][static_cast<std::size_t>(k)] = static_cast<std::int32_t>(std::floor(p[k] + shift));
  }
  return cells;
}

// Joins the positions that share a cell.
void join_in_cells(const std::vector<Cell>& cells, DisjointSets& places) {
  std::vector<std::uint32_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return cells[a] < cells[b]; });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (cells[order[i - 1]] == cells[order[i]]) places.join(order[i - 1], order[i]);
}

}  // namespace

bool is_closed(const ModelMesh& mesh) {
  // What a border between two cells parts, though it is one, lies in one cell of the other grid.
  DisjointSets places(mesh.positions.size());
  for (const double shift : {0.25, 0.75}) join_in_cells(cells_of(mesh.positions, shift), places);
  std::vector<std::uint64_t> up, down;  // edges to the higher and to the lower place, named alike
  std::size_t begin = 0;
  for (const std::size_t end : mesh.ends) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t from = mesh.corners[i], to = mesh.corners[i + 1 < end ? i + 1 : begin];
      if (from >= mesh.positions.size() || to >= mesh.positions.size()) continue;
      const std::uint32_t a = places.find(from), b = places.find(to);
      if (a == b) continue;
      (a < b ? up : down).push_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b));
    }
    begin = end;
  }
  std::sort(up.begin(), up.end());
  std::sort(down.begin(), down.end());
  return up == down;
}

}  // namespace pprt
