// Rounding bounds of the tracer. Each names its bound, what it was counted from, and its test in
// tests/unit/trace or tests/numeric. docs/numerics.md has the same as a table.
//
// Lengths are in the compiled space, where coordinates are below 1.
#pragma once

#include <cmath>

#include "base/vector.h"

namespace pprt {

// Relative error of one rounding to float, u = 2^-24: half a unit in the last place of 1. Source: IEEE 754.
inline constexpr double kFloatRounding = 0x1p-24;

// Largest distance by which a point moves when rounded to float. Counted from: three coordinates below 1,
// each moved by at most 2^-25; sqrt(3) times that. Test: leaving_rays_test.cpp.
inline constexpr double kOriginRounding = 1.7321 * 0x1p-25;

inline bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Returns |x| + |y| + |z|: an upper bound of the length, cheaper to compute.
inline double sum_of_coordinates(const Vec3d& p) {
  return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

// Returns the same bound for one point, given its sum_of_coordinates. Near the origin it is far smaller,
// because floats are finer there. It grows with the distance of bodies that leave the scene. Counted from:
// half a unit in the last place of each coordinate. Test: hard_surfaces_test.cpp, "a huge sphere ...".
constexpr double origin_rounding(double sum_of_coordinates) {
  const double bound = kFloatRounding * sum_of_coordinates;
  return bound < kOriginRounding || sum_of_coordinates > 3 ? bound : kOriginRounding;
}

// Error of a ray's crossing with a sphere or cone, for numbers below 8. Counted from: some sixty operations
// in double, each off by at most 2^-50. Test: quadrics_test.cpp, "a line crosses ...".
inline constexpr double kCrossingError = 64 * 0x1p-50;

// Returns the same where a ray starts on the surface. All numbers are then at most `reach`: the sum of the
// point's coordinates, and the surface's size.
constexpr double crossing_error(double reach) {
  return kCrossingError * reach;
}

// Returns the height above a sphere or cone at which a leaving ray starts. `size`: the largest distance of
// two of its points.
//
// Counted from: the rounding of the origin along the normal, and the crossing's error. As much again for the
// rounding across the normal. It turns the surface by rounding / radius and costs rounding^2 / (2 radius).
// That is less than the rounding itself for every radius above half of it. Test: leaving_rays_test.cpp, "rays
// leave ...".
constexpr double quadric_offset(double sum_of_coordinates, double size) {
  return 2 * (origin_rounding(sum_of_coordinates) + crossing_error(sum_of_coordinates + size));
}

// Largest height above a triangle at which a leaving ray starts. Embree's error grows without bound as
// triangles get thinner. Counted from: it is reached where triangle_offset needs more, on triangles thinner
// than 1/64 of their length. Test: leaving_rays_test.cpp, "rays leave triangles ...".
inline constexpr double kMaxTriangleOffset = 0x1p-15;

// Returns the height above a triangle at which a leaving ray starts.
//
// Bound: the rounding of the origin, plus the error of T = v0 . Ng in Embree's Pluecker test, in float. At
// height h above the plane, T is h |Ng|. Counted from, with l the longest edge and u a rounding:
//   v_i = vertex - origin    errs by u l
//   e = v_i - v_j, an edge   errs by 3 u l
//   Ng = e x e'              errs by 2 (3 u l) l + 2 u l^2 = 8 u l^2
//   T = v0 . Ng              errs by l (8 u l^2) + (1 + 3) u l |Ng|
// Source: Embree 3, kernels/geometry/triangle_intersector_pluecker.h. Test: leaving_rays_test.cpp.
constexpr double triangle_offset(double longest_edge, double twice_area, double sum_of_coordinates) {
  const double l = longest_edge;
  const double bound =
      origin_rounding(sum_of_coordinates) + kFloatRounding * (8 * l * l * l / twice_area + 4 * l);
  return bound < kMaxTriangleOffset ? bound : kMaxTriangleOffset;
}

// Returns the height that two triangles may be apart so that Embree's rounding decides which of them a ray
// meets first. `offset`: their triangle_offset.
//
// Counted from: each triangle_offset covers the rounding of corners and normal. Embree adds 10 u d on a ray
// of length d. A vertex relative to the origin errs by u d, and by sqrt(3) u d in all. The distance is a
// quotient of two dot products. Each of these errs by 3 u d, the quotient by 2 u d. Rays in a scene are
// shorter than 2. Test: coincident_faces_test.cpp.
constexpr double coincidence_bound(double offset, double other_offset) {
  return offset + other_offset + 2 * 10 * kFloatRounding * 2;
}

// Returns how far a ray may miss a body that Embree maps into the world. It is relative to the sums of the
// coordinates of the ray's origin and of the body's. `condition` is the norm of the map times that of its
// inverse: 1 where it turns, and scales all directions alike.
//
// Counted from: Embree inverts the map in float. Some ten roundings of products make each component, and
// these are up to `condition` times the result. Four more roundings map the origin. In the world all that is
// up to `condition` times as long again. Test: moving_bodies_test.cpp, "rays leave ...".
constexpr double instance_rounding(double condition) {
  return kFloatRounding * 16 * condition * condition;
}

// Returns the height that a body's map may add where a ray leaves it: instance_rounding times `reach`, the
// sums of coordinates that it is relative to. At most kMaxTriangleOffset of that. Test:
// moving_bodies_test.cpp, "rays leave ...".
constexpr double instance_offset(double rounding, double reach) {
  const double bound = rounding * reach, most = kMaxTriangleOffset * (reach > 1 ? reach : 1);
  return bound < most ? bound : most;
}

// Flattest angle, as the inverse of its cosine to the normal, at which bounds that grow with it still hold.
inline constexpr double kFlattestCosine = 256;

// Returns how far the end of a shadow ray of this length may lie from its light.
//
// Counted from: the rounding of the origin, of the unit direction (three components, each by at most 2^-25)
// times the length, and of the length. Test: light_contacts_test.cpp.
constexpr double shadow_end_error(double length) {
  return kOriginRounding + (kOriginRounding + kFloatRounding) * length;
}

// Returns how far from a triangle's plane its light may lie so that a shadow ray may meet the triangle or
// not.
//
// Bound: shadow_end_error, the rounding of the vertices, and Embree's error of T = v0 . Ng as in
// triangle_offset. Here the origin is at distance d = `length`, and l is the longest edge. A vertex relative
// to the origin errs by u d. This moves the plane by sqrt(3) u d. An edge errs by u l. Their product Ng errs
// by 4 u l^2. T errs by 4 d u l^2 + 3 u d |Ng|. At most kMaxTriangleOffset, for slivers. Test:
// light_contacts_test.cpp.
constexpr double shadow_end_on_triangle(double length, double longest_edge, double twice_area) {
  const double l = longest_edge;
  const double bound = shadow_end_error(length) + kOriginRounding +
                       kFloatRounding * length * (4 * l * l / twice_area + 3 + 1.7321);
  return bound < kMaxTriangleOffset ? bound : kMaxTriangleOffset;
}

// Returns how much nearer than an earlier hit point an occluder must be to hide it.
//
// Counted from: the hit point was rounded to float, so its own surface may lie before it by the rounding /
// cos(incidence). The bound covers cosines down to 1/256. At flatter angles a visible point may count as
// hidden, and is sampled anew. Test: visibility_test.cpp.
constexpr double visibility_gap(double sum_of_coordinates) {
  return kFlattestCosine * (origin_rounding(sum_of_coordinates) + crossing_error(sum_of_coordinates));
}

// Smallest cosine of a secondary ray with the geometric normal. An interpolated normal can send a ray through
// the surface; the ray is then lifted to this cosine. A choice: a twentieth of a degree, far above rounding
// and too small to be seen. Test: shading_test.cpp, "a mirror patch ...".
inline constexpr double kGrazingCosine = 0x1p-10;

}  // namespace pprt
