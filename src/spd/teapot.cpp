// "teapot": Newell's teapot, flattened patches with smooth normals, on a checkerboard.
#include "spd/teapot_patches.h"

#include <array>
#include <cmath>
#include <vector>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

// The four Bernstein polynomials of degree 3 and their derivatives.
struct CubicBasis {
  std::array<double, 4> value, derivative;

  explicit CubicBasis(double u) {
    const double v = 1 - u;
    value = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
    derivative = {-3 * v * v, 3 * v * v - 6 * u * v, 6 * u * v - 3 * u * u, 3 * u * u};
  }
};

PatchVertex surface_point(const BezierPatch& patch, const CubicBasis& s, const CubicBasis& t) {
  Vec3d position(0), along_s(0), along_t(0);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      position += patch[i][j] * (s.value[i] * t.value[j]);
      along_s += patch[i][j] * (s.derivative[i] * t.value[j]);
      along_t += patch[i][j] * (s.value[i] * t.derivative[j]);
    }
  }
  return {position, along_t.cross(along_s).normalized()};
}

// Adds a triangle unless it has no area. At the lid's top and the bottom's middle a whole patch edge is one
// point without a normal. Triangles with two vertices there are dropped; a single vertex gets the axis as its
// normal.
void triangle(SceneBuilder& out, std::array<PatchVertex, 3> vertices) {
  int cusps = 0;
  for (PatchVertex& vertex : vertices) {
    const Vec3d& p = vertex.position;
    if (std::abs(p.x) > 1e-4 || std::abs(p.y) > 1e-4) continue;
    vertex.normal = Vec3d(0, 0, p.z > 1.5 ? 1 : -1);
    ++cusps;
  }
  if (cusps <= 1) out.patch(vertices);
}

void flattened(SceneBuilder& out, const BezierPatch& patch, const std::vector<CubicBasis>& steps) {
  const std::size_t n = steps.size() - 1;
  std::vector<PatchVertex> grid;  // row by row along s
  grid.reserve(steps.size() * steps.size());
  for (const CubicBasis& s : steps) {
    for (const CubicBasis& t : steps) grid.push_back(surface_point(patch, s, t));
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const PatchVertex* q = &grid[i * (n + 1) + j];
      triangle(out, {q[0], q[1], q[n + 2]});
      triangle(out, {q[n + 2], q[n + 1], q[0]});
    }
  }
}

// Adds the light squares, then the dark ones.
void checkerboard(SceneBuilder& out, int size) {
  const auto coordinate = [size](int i) { return 4 * (2.0 * i / size - 1); };
  for (const int parity : {1, 0}) {
    const Rgb color = parity == 1 ? Rgb(1, 1, 1) : Rgb(0.5, 0.5, 0.5);
    out.fill({.color = color, .diffuse = 0.5, .specular = 0.5, .highlight_degrees = 30});
    for (int s = 0; s < size; ++s) {
      for (int t = 0; t < size; ++t) {
        if ((s + t) % 2 != parity) continue;
        const double x0 = coordinate(s), x1 = coordinate(s + 1);
        const double y0 = coordinate(t), y1 = coordinate(t + 1);
        out.polygon({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}});
      }
    }
  }
}

}  // namespace

void build_teapot(SceneBuilder& out, int size) {
  out.view({4.86, 7.2, 5.4}, {0, 0, 0}, {0, 0, 1}, 1);
  out.lights({{-3.1, 9.8, 12.1}, {11.3, 5.1, 8.8}});
  checkerboard(out, size);

  out.fill({.color = {1, 0.5, 0.1}, .diffuse = 0.75, .specular = 0.25, .highlight_degrees = 37});
  std::vector<CubicBasis> steps;
  for (int i = 0; i <= size; ++i) steps.emplace_back(static_cast<double>(i) / size);
  for (const BezierPatch& patch : teapot_patches()) flattened(out, patch, steps);
}

}  // namespace pprt::spd
