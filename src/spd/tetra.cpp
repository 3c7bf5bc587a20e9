// "tetra": a Sierpinski tetrahedron.
#include <array>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

// Four corners of the cube, no two of which share an edge.
constexpr std::array<Vec3d, 4> kTetrahedron = {Vec3d(-1, -1, 1), Vec3d(-1, 1, -1), Vec3d(1, -1, -1),
                                               Vec3d(1, 1, 1)};

// Adds a tetrahedron of the given level. `half_width` is half the edge of the cube around it.
void tetrahedron(SceneBuilder& out, const Vec3d& center, double half_width, int level) {
  if (level > 1) {
    for (const Vec3d& corner : kTetrahedron) {
      tetrahedron(out, center + corner * (half_width / 2), half_width / 2, level - 1);
    }
    return;
  }
  std::array<Vec3d, 4> q;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = center + kTetrahedron[i] * half_width;
  out.polygon({q[0], q[1], q[2]});
  out.polygon({q[3], q[2], q[1]});
  out.polygon({q[2], q[3], q[0]});
  out.polygon({q[1], q[0], q[3]});
}

}  // namespace

void build_tetra(SceneBuilder& out, int size) {
  out.view({1.022846, -3.177154, -2.174512}, {-0.004103, -0.004103, 0.216539},
           {-0.816497, -0.816497, 0.816497}, 1);
  out.lights({{2, -18, -5}});
  out.fill({.color = {1, 0.2, 0.2}});
  tetrahedron(out, {0, 0, 0}, 1, size);
}

}  // namespace pprt::spd
