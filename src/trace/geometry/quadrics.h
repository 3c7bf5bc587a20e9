// Spheres and open cones (cylinders among them): intersection with a line, in double.
//
// Both are boundaries of convex bodies, so a line enters the body once and leaves it once. A cone's ends are
// open, so either crossing may be missing. Directions have unit length up to rounding to float.
//
// Error of a crossing: crossing_error (numerics.h). Test: quadrics_test.cpp.
#pragma once

#include <cmath>
#include <limits>

#include "base/vector.h"

namespace pprt {

// A sphere in the compiled space.
struct SphereRecord {
  Vec3d center{0, 0, 0};
  double radius = 1;  // positive
};
static_assert(sizeof(SphereRecord) == 32);

// The lateral surface between two parallel discs.
struct ConeRecord {
  Vec3d base{0, 0, 0};
  Vec3d axis{0, 0, 1};       // from base to apex, not zero
  double base_radius = 1;    // not negative
  double radius_change = 0;  // apex radius minus base radius
};
static_assert(sizeof(ConeRecord) == 64);

// Ray parameters of the crossings; NaN where there is none.
struct Crossings {
  double front = std::numeric_limits<double>::quiet_NaN();  // enters the body, through its outer face
  double back = std::numeric_limits<double>::quiet_NaN();   // leaves the body, through its inner face
};

// A point of a surface with its geometric normal.
struct SurfacePoint {
  Vec3d position{0, 0, 0};
  Vec3d normal{0, 0, 1};  // unit, outwards
};

// Returns v / |v|; v must not be zero.
inline Vec3d unit(const Vec3d& v) {
  return v * (1 / std::sqrt(v.dot(v)));
}

// Intersects a line with a sphere. The line's origin is first moved to its point nearest the centre. The
// discriminant then subtracts only the radius squared, so a far ray loses no digits.
inline Crossings crossings(const SphereRecord& sphere, const Vec3d& origin, const Vec3d& direction) {
  const Vec3d from_center = origin - sphere.center;
  const double to_middle = -from_center.dot(direction);
  const Vec3d middle = from_center + direction * to_middle;
  const double a = direction.dot(direction);
  const double b = middle.dot(direction);  // zero up to rounding
  const double c = middle.dot(middle) - sphere.radius * sphere.radius;
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return {};
  const double root = std::sqrt(discriminant);
  const double inverse = 1 / a;
  return {to_middle + (-b - root) * inverse, to_middle + (-b + root) * inverse};
}

// Intersects a line with an open cone or cylinder.
//
// Let q be a point relative to the base, L the axis' length, m = q . axis, r0 the base radius, dr the radius
// change. The surface is L^2 |q x axis|^2 = (r0 L^2 + dr m)^2. The form has no division. The body is where
// the left side is smaller.
inline Crossings crossings(const ConeRecord& cone, const Vec3d& origin, const Vec3d& direction) {
  const Vec3d from_base = origin - cone.base;
  const double to_middle = -from_base.dot(direction);
  const Vec3d middle = from_base + direction * to_middle;

  const double length2 = cone.axis.dot(cone.axis);
  const Vec3d across = direction.cross(cone.axis);
  const Vec3d aside = middle.cross(cone.axis);
  const double along = direction.dot(cone.axis);
  const double height = middle.dot(cone.axis);
  const double growth = cone.radius_change * along;
  const double radius = cone.base_radius * length2 + cone.radius_change * height;

  const double a = length2 * across.dot(across) - growth * growth;
  const double b = length2 * across.dot(aside) - radius * growth;
  const double c = length2 * aside.dot(aside) - radius * radius;
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return {};

  // At its roots the surface function has slope -root (entering) and +root (leaving), whatever the sign of a.
  // Each root is computed in the form that does not cancel.
  const double root = std::sqrt(discriminant);
  const double sum = b >= 0 ? -b - root : -b + root;
  double front = (b >= 0 ? sum / a : c / sum);
  double back = (b >= 0 ? c / sum : sum / a);
  const auto within = [&](double t) {
    const double h = height + t * along;
    return h >= 0 && h <= length2;
  };
  Crossings result;
  if (within(front)) result.front = to_middle + front;
  if (within(back)) result.back = to_middle + back;
  return result;
}

// Returns the ray parameter of the crossing nearest to `t`, which was found in float; `t` itself where the
// line passes beside the surface by that rounding. The direction may have any length.
template <class Record>
double refined(const Record& record, const Vec3d& origin, const Vec3d& direction, double t) {
  const double length = std::sqrt(direction.dot(direction));
  const Crossings exact = crossings(record, origin, direction * (1 / length));
  const double front = exact.front / length, back = exact.back / length;
  if (std::isnan(front) && std::isnan(back)) return t;
  const bool is_back = std::isnan(front) || std::abs(back - t) < std::abs(front - t);
  return is_back ? back : front;
}

// Returns a bound of the distance of two points of the surface, cheap to compute.
inline double extent(const SphereRecord& sphere) {
  return 2 * sphere.radius;
}
inline double extent(const ConeRecord& cone) {
  return std::abs(cone.axis.x) + std::abs(cone.axis.y) + std::abs(cone.axis.z) +
         2 * (cone.base_radius + std::abs(cone.radius_change));
}

// Projects a point that lies on the surface up to rounding onto it. Returns the point and its normal.
// Rounding may put a point of a tiny sphere at its centre, where any normal will do.
inline SurfacePoint on_surface(const SphereRecord& sphere, const Vec3d& near) {
  const Vec3d aside = near - sphere.center;
  const bool has_direction = aside.dot(aside) >= std::numeric_limits<double>::min();
  const Vec3d normal = has_direction ? unit(aside) : Vec3d(0, 0, 1);
  return {sphere.center + normal * sphere.radius, normal};
}

// Moves the point within its height on the axis. At the very tip of a cone the normal is the axis.
inline SurfacePoint on_surface(const ConeRecord& cone, const Vec3d& near) {
  const Vec3d from_base = near - cone.base;
  const double per_length2 = 1 / cone.axis.dot(cone.axis);
  const double height = std::fmin(1.0, std::fmax(0.0, from_base.dot(cone.axis) * per_length2));
  const Vec3d on_axis = cone.base + cone.axis * height;
  const Vec3d aside = near - on_axis;
  const double distance = std::sqrt(aside.dot(aside));
  if (distance == 0) return {on_axis, unit(cone.axis)};
  const Vec3d radial = aside * (1 / distance);
  const double radius = cone.base_radius + cone.radius_change * height;
  return {on_axis + radial * radius, unit(radial - cone.axis * (cone.radius_change * per_length2))};
}

// Returns the mean curvature at a point of the surface, > 0 as it bulges outwards.
inline double mean_curvature(const SphereRecord& sphere, const Vec3d&) {
  return 1 / sphere.radius;
}

// A cone is curved around its axis alone: by the cosine of its slope over the radius. The tip counts as flat.
inline double mean_curvature(const ConeRecord& cone, const Vec3d& position) {
  const double length2 = cone.axis.dot(cone.axis);
  const double radius =
      cone.base_radius + cone.radius_change * (position - cone.base).dot(cone.axis) / length2;
  if (!(radius > 0)) return 0;
  return 0.5 / (radius * std::sqrt(1 + cone.radius_change * cone.radius_change / length2));
}

// Returns the axis-parallel bounding box, exact up to rounding.
inline Box3d bounds(const SphereRecord& sphere) {
  const Vec3d half(sphere.radius);
  return {sphere.center - half, sphere.center + half};
}

inline Box3d bounds(const ConeRecord& cone) {
  const Vec3d axis = unit(cone.axis);
  const auto disc = [](double n) { return std::sqrt(std::fmax(0.0, 1 - n * n)); };
  const Vec3d half(disc(axis.x), disc(axis.y), disc(axis.z));
  const Vec3d apex = cone.base + cone.axis;
  const double apex_radius = cone.base_radius + cone.radius_change;
  Box3d box;
  box.extendBy(cone.base - half * cone.base_radius);
  box.extendBy(cone.base + half * cone.base_radius);
  box.extendBy(apex - half * apex_radius);
  box.extendBy(apex + half * apex_radius);
  return box;
}

}  // namespace pprt
