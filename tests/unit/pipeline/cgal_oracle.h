// CGAL's triangulation of the same points, in a form that compares.
#pragma once

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "base/vector.h"

namespace pprt {

// Corners in their order, from the lexicographically smallest on, as x, y, x, y, x, y.
using TriangleKey = std::array<double, 6>;

inline TriangleKey triangle_key(std::array<Vec2d, 3> corners) {
  const auto smallest = std::min_element(corners.begin(), corners.end(), [](const Vec2d& a, const Vec2d& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  });
  std::rotate(corners.begin(), smallest, corners.end());
  return {corners[0].x, corners[0].y, corners[1].x, corners[1].y, corners[2].x, corners[2].y};
}

inline std::set<TriangleKey> cgal_triangles(std::span<const Vec2d> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Oracle = CGAL::Delaunay_triangulation_2<Kernel>;
  std::vector<Kernel::Point_2> input;
  input.reserve(points.size());
  for (const Vec2d& p : points) input.emplace_back(p.x, p.y);
  const Oracle oracle(input.begin(), input.end());
  std::set<TriangleKey> keys;
  if (oracle.dimension() < 2) return keys;
  for (auto face = oracle.finite_faces_begin(); face != oracle.finite_faces_end(); ++face) {
    const auto corner = [&](int i) {
      return Vec2d(face->vertex(i)->point().x(), face->vertex(i)->point().y());
    };
    keys.insert(triangle_key({corner(0), corner(1), corner(2)}));
  }
  return keys;
}

}  // namespace pprt
