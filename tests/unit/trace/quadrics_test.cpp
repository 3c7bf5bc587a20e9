#include "trace/geometry/quadrics.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

namespace pprt::quadrics_test {

namespace {

constexpr int kRays = 100000;

// kCrossingError of trace/numerics.h, counted here again. A point within 4 of the origin costs a handful of
// operations on numbers below 8, each off by at most 2^-50. A crossing takes some sixty.
constexpr double kTolerance = 64 * 0x1p-50;

// Discriminants this close to zero may fall on either side.
constexpr double kTangent = 1e-9;

class Random {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3d point(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  // A unit vector as rays carry it: rounded to float.
  Vec3d direction_towards(const Vec3d& from, const Vec3d& to) { return Vec3d(Vec3f(unit(to - from))); }

 private:
  std::mt19937_64 engine_{7};
};

double signed_distance(const SphereRecord& s, const Vec3d& p) {
  return (p - s.center).length() - s.radius;
}

// Across the axis, at the height of the point.
double signed_distance(const ConeRecord& c, const Vec3d& p) {
  const double height = (p - c.base).dot(c.axis) / c.axis.length2();
  const double from_axis = (p - c.base).cross(c.axis).length() / c.axis.length();
  return from_axis - (c.base_radius + c.radius_change * height);
}

double height(const ConeRecord& c, const Vec3d& p) {
  return (p - c.base).dot(c.axis) / c.axis.length2();
}

// Checks the sense of a crossing by looking a little before and behind it: the outside is left (front) or
// entered (back).
template <class Record>
void check_sense(const Record& record, const Vec3d& o, const Vec3d& d, const Crossings& found) {
  const double step = 1e-7;
  const auto slope = [&](double t) {
    return signed_distance(record, o + d * (t + step)) - signed_distance(record, o + d * (t - step));
  };
  if (!std::isnan(found.front) && std::abs(slope(found.front)) > 1e-12) REQUIRE(slope(found.front) < 0);
  if (!std::isnan(found.back) && std::abs(slope(found.back)) > 1e-12) REQUIRE(slope(found.back) > 0);
}

ConeRecord random_cone(Random& random, int kind) {
  ConeRecord cone;
  cone.base = random.point(1);
  cone.axis = random.point(1);
  cone.base_radius = random.between(0.01, 1);
  // In turn a cylinder, a cone with a tip, a frustum, and one that widens.
  const double apex_radius[] = {cone.base_radius, 0, 0.3 * cone.base_radius, 2 * cone.base_radius};
  cone.radius_change = apex_radius[kind % 4] - cone.base_radius;
  return cone;
}

}  // namespace

TEST_CASE("a line crosses a sphere where the closed form says") {
  Random random;
  int crossed = 0;
  double worst = 0;
  for (int i = 0; i < kRays; ++i) {
    const SphereRecord sphere{random.point(1), random.between(0.001, 1)};
    const Vec3d o = random.point(2);
    const Vec3d d = random.direction_towards(o, sphere.center + random.point(sphere.radius));
    const Crossings found = crossings(sphere, o, d);
    // The distance of the line from the centre decides, without any quadratic.
    const double apart = (sphere.center - o).cross(d).length() / d.length();
    if (std::abs(apart - sphere.radius) < kTangent) continue;
    REQUIRE(std::isnan(found.front) == (apart > sphere.radius));
    REQUIRE(std::isnan(found.back) == (apart > sphere.radius));
    if (std::isnan(found.front)) continue;
    ++crossed;
    REQUIRE(found.front < found.back);
    worst = std::max({worst, std::abs(signed_distance(sphere, o + d * found.front)),
                      std::abs(signed_distance(sphere, o + d * found.back))});
    const double half_chord = std::sqrt(sphere.radius * sphere.radius - apart * apart) / d.length();
    REQUIRE(found.back - found.front == Approx(2 * half_chord).epsilon(1e-6));
  }
  CHECK(crossed > kRays / 4);
  CHECK(worst < kTolerance);
}

TEST_CASE("a line crosses cones and cylinders on their surface, between their ends, in the right sense") {
  Random random;
  int crossed = 0;
  double worst = 0;
  for (int i = 0; i < kRays; ++i) {
    const ConeRecord cone = random_cone(random, i);
    if (cone.axis.length() < 0.05) continue;
    const Vec3d o = random.point(2);
    const Vec3d d =
        random.direction_towards(o, cone.base + cone.axis * random.between(0, 1) + random.point(0.5));
    const Crossings found = crossings(cone, o, d);
    for (const double t : {found.front, found.back}) {
      if (std::isnan(t)) continue;
      ++crossed;
      worst = std::max(worst, std::abs(signed_distance(cone, o + d * t)));
      REQUIRE(height(cone, o + d * t) >= -1e-12);
      REQUIRE(height(cone, o + d * t) <= 1 + 1e-12);
    }
    check_sense(cone, o, d, found);
  }
  CHECK(crossed > kRays / 4);
  CHECK(worst < kTolerance);
}

TEST_CASE("no crossing of a cone is missed: marching along the line finds the same ones") {
  Random random;
  int changes = 0;
  for (int i = 0; i < 4000; ++i) {
    const ConeRecord cone = random_cone(random, i);
    if (cone.axis.length() < 0.1) continue;
    const Vec3d o = random.point(2);
    const Vec3d d =
        random.direction_towards(o, cone.base + cone.axis * random.between(0, 1) + random.point(0.5));
    const Crossings found = crossings(cone, o, d);
    constexpr double kStep = 0.005;
    for (double t = 0; t < 6; t += kStep) {
      const Vec3d p = o + d * t;
      const Vec3d q = o + d * (t + kStep);
      if (std::min(height(cone, p), height(cone, q)) < 0 || std::max(height(cone, p), height(cone, q)) > 1)
        continue;
      if ((signed_distance(cone, p) > 0) == (signed_distance(cone, q) > 0)) continue;
      ++changes;
      const double expected = signed_distance(cone, p) > 0 ? found.front : found.back;
      REQUIRE(expected > t - 1e-9);
      REQUIRE(expected < t + kStep + 1e-9);
    }
  }
  CHECK(changes > 1000);
}

TEST_CASE("a sphere seen from a million radii away keeps its surface") {
  const SphereRecord sphere{{0.1, 0.2, 0.3}, 1e-6};
  const Vec3d o(0.9, -0.4, 0.7);
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d target = sphere.center + unit(random.point(1)) * (0.5 * sphere.radius);
    const Vec3d d = unit(target - o);
    const Crossings found = crossings(sphere, o, d);
    REQUIRE(std::abs(signed_distance(sphere, o + d * found.front)) < 1e-9 * sphere.radius + kTolerance);
  }
}

TEST_CASE("normals point outwards and stand square on the surface") {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const ConeRecord cone = random_cone(random, i);
    if (cone.axis.length() < 0.05) continue;
    const Vec3d axis = unit(cone.axis);
    const Vec3d radial = unit(random.point(1).cross(axis));
    const double h = random.between(0.01, 0.99);
    const Vec3d p = cone.base + cone.axis * h + radial * (cone.base_radius + cone.radius_change * h);
    const SurfacePoint found = on_surface(cone, p + radial * 1e-9);
    const Vec3d generator = unit(cone.axis + radial * cone.radius_change);
    const Vec3d around = axis.cross(radial);
    REQUIRE((found.position - p).length() < 1e-12);
    REQUIRE(found.normal.length() == Approx(1).epsilon(1e-14));
    REQUIRE(std::abs(found.normal.dot(generator)) < 1e-12);
    REQUIRE(std::abs(found.normal.dot(around)) < 1e-9);
    REQUIRE(found.normal.dot(radial) > 0);
  }
  const SphereRecord sphere{{1, 2, 3}, 2};
  const SurfacePoint top = on_surface(sphere, {1, 2, 5.001});
  CHECK((top.position - Vec3d(1, 2, 5)).length() < 1e-15);
  CHECK((top.normal - Vec3d(0, 0, 1)).length() < 1e-15);
}

TEST_CASE("the tip of a cone has a normal") {
  const ConeRecord cone{{0, 0, 0}, {0, 0, 2}, 1, -1};
  const SurfacePoint tip = on_surface(cone, {0, 0, 2});
  CHECK(tip.position == Vec3d(0, 0, 2));
  CHECK(tip.normal == Vec3d(0, 0, 1));
}

TEST_CASE("what rounding puts at a sphere's centre has a normal, and a place on it") {
  const Vec3d center(0.25, -3, 1e-30);
  for (const double radius : {1e-9, 1e-48, 1e-200}) {
    for (const double aside : {0.0, 1e-170, -1e-162, 1e-100}) {
      const SurfacePoint point = on_surface(SphereRecord{center, radius}, center + Vec3d(0, 0, aside));
      CHECK(point.normal.length() == Approx(1));
      CHECK((point.position - center).length() <= radius * 1.001);
    }
  }
}

TEST_CASE("bounds hold every point of a cone and touch it") {
  const ConeRecord cone{{1, 0, 0}, {0, 0, 2}, 0.5, 0.25};
  const Box3d box = bounds(cone);
  CHECK(box.min == Vec3d(0.25, -0.75, 0));
  CHECK(box.max == Vec3d(1.75, 0.75, 2));
}

}  // namespace pprt::quadrics_test
