#include "convert/model/closed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace pprt {
namespace {

constexpr double kCell = 1e-4;  // of the mesh's longest side: beyond rounding, below what is seen

// Returns the cell of a grid that each position lies in, by the same number for the same cell. `shift`: of
// the grid, in cells.
std::vector<std::uint32_t> places(const std::vector<Vec3d>& positions, double shift) {
  Box3d box;
  for (const Vec3d& p : positions) {
    if (is_in_range(p)) box.extendBy(p);
  }
  const Vec3d size = box.isEmpty() ? Vec3d(0, 0, 0) : box.size();
  const double longest = std::max({size.x, size.y, size.z});
  const double scale = longest > 0 ? 1 / (kCell * longest) : 0;
  std::vector<std::array<std::int32_t, 3>> cells(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!is_in_range(positions[i])) continue;
    const Vec3d p = (positions[i] - box.min) * scale;
    for (int k = 0; k < 3; ++k)
      cells[i][static_cast<std::size_t>(k)] = static_cast<std::int32_t>(std::floor(p[k] + shift));
  }
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return cells[a] < cells[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || cells[order[i - 1]] != cells[order[i]];
    place[order[i]] = is_new ? order[i] : place[order[i - 1]];
  }
  return place;
}

bool is_closed(const ModelMesh& mesh, const std::vector<std::uint32_t>& place) {
  std::vector<std::uint64_t> up, down;  // edges to the higher and to the lower place, named alike
  std::size_t begin = 0;
  for (const std::size_t end : mesh.ends) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t from = mesh.corners[i], to = mesh.corners[i + 1 < end ? i + 1 : begin];
      if (from >= place.size() || to >= place.size() || place[from] == place[to]) continue;
      const auto [low, high] = std::minmax(place[from], place[to]);
      (place[from] == low ? up : down).push_back(std::uint64_t{low} << 32 | high);
    }
    begin = end;
  }
  std::sort(up.begin(), up.end());
  std::sort(down.begin(), down.end());
  return up == down;
}

}  // namespace

bool is_closed(const ModelMesh& mesh) {
  // Where a border between two cells parts what is one, it does not on the other grid.
  return is_closed(mesh, places(mesh.positions, 0.25)) || is_closed(mesh, places(mesh.positions, 0.75));
}

}  // namespace pprt
