// Rounding bounds of the tracer, each with the operations it was counted from (docs/numerics.md tells more).
#pragma once

#include <cmath>

#include "base/vector.h"

namespace pprt {

// Relative error of one rounding to float: half a unit in the last place of 1.
inline constexpr double kFloatRounding = 0x1p-24;

// How far a point of the scene moves when its three coordinates are rounded to float: each lies below 1, so
// it moves by at most 2^-25, and the point by sqrt(3) times that.
inline constexpr double kOriginRounding = 1.7321 * 0x1p-25;

// Of absolute values: at least the length, and cheaper.
inline double sum_of_coordinates(const Vec3d& p) {
  return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

// The same of a point whose coordinates add up to no more than this, which may be far less: near the origin
// floats are fine.
constexpr double origin_rounding(double sum_of_coordinates) {
  const double bound = kFloatRounding * sum_of_coordinates;
  return bound < kOriginRounding ? bound : kOriginRounding;
}

// By how much the crossing of a ray with a sphere or cone is off: some sixty operations in double.
inline constexpr double kCrossingError = 64 * 0x1p-50;

// How far above a sphere or cone a leaving ray starts: once for the rounding of its origin along the normal;
// once more because the rounding across the normal turns the surface under it, by rounding / radius, which
// costs rounding^2 / (2 radius): less than the rounding itself for every radius above half of it.
constexpr double quadric_offset(double sum_of_coordinates) {
  return 2 * (origin_rounding(sum_of_coordinates) + kCrossingError);
}

// A ray that leaves a triangle starts at most this far above it. Embree's error on a triangle grows with its
// slenderness without bound; a triangle that would need more is too thin to be seen from where it matters.
inline constexpr double kMaxTriangleOffset = 0x1p-15;

// How far above a triangle a leaving ray starts: the rounding of its origin, and the error of the distance
// T = v0 . Ng that Embree's Pluecker test finds in float. There, with l the longest edge and u a rounding:
// v_i = vertex - origin errs by u l; an edge e = v_i - v_j by 3 u l; Ng = e x e' by 2 (3 u l) l + 2 u l^2;
// the product v0 . Ng by l (8 u l^2) + (1 + 3) u l |Ng|. Above the plane by h, T is h |Ng|.
constexpr double triangle_offset(double longest_edge, double twice_area, double sum_of_coordinates) {
  const double l = longest_edge;
  const double bound =
      origin_rounding(sum_of_coordinates) + kFloatRounding * (8 * l * l * l / twice_area + 4 * l);
  return bound < kMaxTriangleOffset ? bound : kMaxTriangleOffset;
}

// A point seen before counts as visible when nothing lies before it by more than this. It was rounded to
// float, so its own surface may stand before it by the rounding / cos(incidence): bridged down to a cosine
// of 1/256. Beyond that a point is at worst taken for hidden, and sampled anew.
constexpr double visibility_gap(double sum_of_coordinates) {
  return 256 * (origin_rounding(sum_of_coordinates) + kCrossingError);
}

// A mirrored or refracted direction that an interpolated normal sends through the surface is lifted to this
// cosine with the geometric normal.
inline constexpr double kGrazingCosine = 0x1p-10;

}  // namespace pprt
