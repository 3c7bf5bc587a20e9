// "lattice": spheres joined by rods, filling the unit cube; the eye is inside.
#include <array>
#include <cmath>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

constexpr std::array<Vec3d, 3> kAxes = {kAxisX, kAxisY, kAxisZ};
constexpr std::array<Rgb, 3> kRodColors = {Rgb(0.9, 0.1, 0.1), Rgb(0.1, 0.9, 0.1), Rgb(0.1, 0.1, 0.9)};

// Adds the sphere at a node and the rods from it towards larger coordinates.
void lattice_node(SceneBuilder& out, const std::array<int, 3>& node, int size) {
  const double sphere_radius = 0.25 / size;
  const double rod_radius = 0.0625 / size;
  // The rod starts inside the sphere, so that it leaves no gap.
  const double start = 0.99 * sphere_radius * (1 - std::sqrt(rod_radius / sphere_radius));

  const Vec3d center = Vec3d(node[0], node[1], node[2]) / size;
  out.fill({.color = {0.9, 0.9, 0.9}, .diffuse = 0.5, .specular = 0.5, .highlight_degrees = 37});
  out.sphere(center, sphere_radius);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (node[axis] == size) continue;
    out.fill({.color = kRodColors[axis], .diffuse = 0.99});
    out.cylinder(center + kAxes[axis] * start, center + kAxes[axis] * (1.0 / size - start), rod_radius);
  }
}

}  // namespace

void build_lattice(SceneBuilder& out, int size) {
  const double half_cell = 0.5 / size;
  const int middle = size / 2;
  const double x = (middle + 0.5) / size;  // between two layers of nodes
  out.view({x, 1, 1 - half_cell}, {x, -1, -1 - half_cell}, {0.2, 1, 0}, 0);
  out.scene.view->angle_degrees = 60;
  out.lights({{2, 0.5, 0.5}, {-1, 0.5, 0.5}, {0.5, 2, 0.5}, {0.5, -1, 0.5}, {0.5, 0.5, 2}, {0.5, 0.5, -1}});
  for (int i = 0; i <= size; ++i) {
    for (int j = 0; j <= size; ++j) {
      for (int k = 0; k <= size; ++k) lattice_node(out, {i, j, k}, size);
    }
  }
}

}  // namespace pprt::spd
