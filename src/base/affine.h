// Affine maps of space: how an object stands in the space around it.
#pragma once

#include <cmath>

#include "base/vector.h"

namespace pprt {

// Maps (1, 0, 0) to x, and so on: the columns of a matrix that is applied to column vectors.
struct Affine {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Vec3d origin{0, 0, 0};

  Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d point(const Vec3d& p) const { return vector(p) + origin; }

  // Maps the normal of a surface, by the cofactors: the inverse transpose times the determinant. Its length
  // is not kept. It points to the side to which the map turns the surface's front, also where the map
  // mirrors.
  Vec3d normal(const Vec3d& n) const { return y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z; }

  // The same, but it points to the side to which the map takes what lies on the normal's side: outwards stays
  // outwards where the map mirrors.
  Vec3d outward(const Vec3d& n) const { return determinant() < 0 ? -normal(n) : normal(n); }

  // Negative where the map mirrors, 0 where it flattens.
  double determinant() const { return x.dot(y.cross(z)); }

  friend bool operator==(const Affine&, const Affine&) = default;
};

// Returns the inverse of a map whose determinant is not 0.
inline Affine inverse(const Affine& map) {
  const Vec3d yz = map.y.cross(map.z), zx = map.z.cross(map.x), xy = map.x.cross(map.y);
  const double per_volume = 1 / map.x.dot(yz);
  Affine result{Vec3d(yz.x, zx.x, xy.x) * per_volume,
                Vec3d(yz.y, zx.y, xy.y) * per_volume,
                Vec3d(yz.z, zx.z, xy.z) * per_volume,
                {0, 0, 0}};
  result.origin = -result.vector(map.origin);
  return result;
}

// Returns the axis-parallel box of a mapped box. An empty box stays empty.
inline Box3d mapped(const Affine& map, const Box3d& box) {
  if (box.isEmpty()) return box;
  const Vec3d middle = map.point(box.min * 0.5 + box.max * 0.5), half = (box.max - box.min) * 0.5;
  Vec3d reach;
  for (int i = 0; i < 3; ++i)
    reach[i] = std::abs(map.x[i]) * half.x + std::abs(map.y[i]) * half.y + std::abs(map.z[i]) * half.z;
  return {middle - reach, middle + reach};
}

// First inner, then outer.
inline Affine operator*(const Affine& outer, const Affine& inner) {
  return {outer.vector(inner.x), outer.vector(inner.y), outer.vector(inner.z), outer.point(inner.origin)};
}

inline Affine translation(const Vec3d& by) {
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by};
}

inline Affine scaling(const Vec3d& by) {
  return {{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {0, 0, 0}};
}

}  // namespace pprt
