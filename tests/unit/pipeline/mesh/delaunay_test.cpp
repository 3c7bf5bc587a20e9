#include "pipeline/mesh/delaunay.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "pipeline/mesh/predicates.h"
#include "unit/pipeline/cgal_oracle.h"

namespace pprt::delaunay_test {
namespace {

bool insert(Delaunay& delaunay, const Vec2d& point) {
  if (!delaunay.is_planar()) return delaunay.insert_before_planar(point);
  const Delaunay::Index at = delaunay.locate(point, 0);
  if (at == Delaunay::kNowhere) return false;
  delaunay.insert(point, at);
  return true;
}

Delaunay triangulation(const std::vector<Vec2d>& points) {
  Delaunay delaunay;
  for (const Vec2d& p : points) insert(delaunay, p);
  return delaunay;
}

std::set<TriangleKey> finite_triangles(const Delaunay& delaunay) {
  std::set<TriangleKey> keys;
  for (const Delaunay::Triangle& t : delaunay.triangles()) {
    if (!t.is_finite()) continue;
    const auto corner = [&](std::size_t i) { return delaunay.points()[t.corners[i]]; };
    keys.insert(triangle_key({corner(0), corner(1), corner(2)}));
  }
  return keys;
}

// Whether every side knows its other side, which has the same ends in the other order.
bool is_linked(const Delaunay& delaunay) {
  const auto& triangles = delaunay.triangles();
  for (Delaunay::Index t = 0; t < triangles.size(); ++t) {
    for (unsigned edge = 0; edge < 3; ++edge) {
      const Delaunay::Side across = triangles[t].across[edge];
      const auto& other = triangles[across / 4];
      const unsigned back = across % 4;
      if (other.across[back] != 4 * t + edge) return false;
      if (other.corners[(back + 1) % 3] != triangles[t].corners[(edge + 2) % 3]) return false;
      if (other.corners[(back + 2) % 3] != triangles[t].corners[(edge + 1) % 3]) return false;
    }
  }
  return true;
}

std::vector<Vec2d> random_points(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> anywhere(0, 100);
  std::vector<Vec2d> points;
  for (int i = 0; i < count; ++i) points.emplace_back(anywhere(random), anywhere(random));
  return points;
}

std::vector<Vec2d> grid_points(int side) {
  std::vector<Vec2d> points;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) points.emplace_back(x, y);
  }
  return points;
}

// All cocircular: whole numbers whose squares add up to 5525 = 5 * 5 * 13 * 17.
std::vector<Vec2d> circle_points() {
  std::vector<Vec2d> points;
  for (int y = -74; y <= 74; ++y) {
    for (int x = -74; x <= 74; ++x) {
      if (x * x + y * y == 5525) points.emplace_back(x + 80, y + 80);
    }
  }
  return points;
}

std::vector<Vec2d> fan_points() {
  std::vector<Vec2d> points = {{50, 1e-9}, {50, 100}};
  for (int x = 0; x <= 100; ++x) points.emplace_back(x, 0);
  for (int i = 0; i < 40; ++i) points.emplace_back(50 + i * 1e-12, 40 + i * 1e-12);
  return points;
}

}  // namespace

TEST_CASE("delaunay: the triangles are CGAL's, whatever the points and their order") {
  std::mt19937 random(3);
  const auto seed = GENERATE(range(0, 5));
  random.seed(static_cast<unsigned>(seed));
  for (std::vector<Vec2d> points :
       {random_points(random, 2000), grid_points(24), circle_points(), fan_points()}) {
    const std::set<TriangleKey> expected = cgal_triangles(points);
    for (int order = 0; order < 3; ++order) {
      std::shuffle(points.begin(), points.end(), random);
      const Delaunay delaunay = triangulation(points);
      CHECK(delaunay.points().size() == points.size());
      CHECK(is_linked(delaunay));
      CHECK((finite_triangles(delaunay) == expected));
    }
  }
}

TEST_CASE("delaunay: the triangles are CGAL's after every single insertion") {
  std::mt19937 random(11);
  std::vector<Vec2d> points = grid_points(6);
  for (const Vec2d& p : random_points(random, 40)) points.push_back(p / 20.0);
  std::shuffle(points.begin(), points.end(), random);
  Delaunay delaunay;
  for (std::size_t n = 1; n <= points.size(); ++n) {
    REQUIRE(insert(delaunay, points[n - 1]));
    REQUIRE(is_linked(delaunay));
    REQUIRE((finite_triangles(delaunay) == cgal_triangles({points.data(), n})));
  }
}

TEST_CASE("delaunay: a circle and a point are judged as in exact arithmetic, unless rounding might decide") {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> angle(0, 6.283185307179586), share(0, 1);
  std::vector<Vec2d> far_off = random_points(random, 400);
  for (Vec2d& p : far_off) p = p * 1e-3 + Vec2d(32000, 31000);
  int decided = 0, tried = 0;
  for (const auto& points :
       {random_points(random, 400), grid_points(16), circle_points(), fan_points(), far_off}) {
    const Delaunay delaunay = triangulation(points);
    for (Delaunay::Index i = 0; i < delaunay.triangles().size(); ++i) {
      const Delaunay::Triangle& t = delaunay.triangles()[i];
      if (!t.is_finite()) continue;
      const auto corner = [&](std::size_t c) { return delaunay.points()[t.corners[c]]; };
      for (int trial = 0; trial < 20; ++trial) {
        // Upon the circle as far as rounding allows; one in four somewhere around it.
        const double turn = angle(random), away = trial % 4 == 0 ? 2 * share(random) : 1;
        const Vec2d p = delaunay.circumcenter(i) +
                        Vec2d(std::cos(turn), std::sin(turn)) * (away * std::sqrt(t.circle.radius_squared()));
        const int side = side_of_circle(t.circle, p - corner(2));
        const int exact = exact_in_circle(corner(0), corner(1), corner(2), p);
        if (side != 0) REQUIRE(side == exact);
        if (away != 1) decided += side != 0, ++tried;
      }
    }
  }
  CHECK(decided > 0.9 * tried);
}

TEST_CASE("delaunay: points on a line make no triangle until one lies off the line") {
  Delaunay delaunay;
  for (const double x : {3.0, 1.0, 2.0, 9.0, 4.0}) CHECK(insert(delaunay, {x, 2 * x}));
  CHECK_FALSE(insert(delaunay, {9, 18}));
  CHECK_FALSE(delaunay.is_planar());
  CHECK(insert(delaunay, {5, 0}));
  REQUIRE(delaunay.is_planar());
  CHECK(is_linked(delaunay));
  CHECK(finite_triangles(delaunay).size() == 4);
  CHECK((finite_triangles(delaunay) == cgal_triangles(delaunay.points())));
  delaunay.clear();
  CHECK_FALSE(delaunay.is_planar());
  CHECK(delaunay.points().empty());
}

TEST_CASE("delaunay: new triangles are exactly those around the inserted point") {
  std::mt19937 random(5);
  Delaunay delaunay = triangulation(random_points(random, 300));
  for (const Vec2d& p : random_points(random, 300)) {
    const std::size_t slots = delaunay.triangles().size();
    REQUIRE(insert(delaunay, p));
    const auto apex = static_cast<Delaunay::Index>(delaunay.points().size() - 1);
    std::set<Delaunay::Index> around;
    for (Delaunay::Index t = 0; t < delaunay.triangles().size(); ++t) {
      const auto& corners = delaunay.triangles()[t].corners;
      if (std::count(corners.begin(), corners.end(), apex) == 1) around.insert(t);
    }
    const auto made = delaunay.new_triangles();
    CHECK((around == std::set<Delaunay::Index>(made.begin(), made.end())));
    CHECK(made.size() == around.size());
    CHECK(delaunay.triangles().size() == slots + 2);
  }
}

TEST_CASE("delaunay: surely_holds() accepts only a circle that strictly holds the point") {
  const Delaunay delaunay = triangulation({{0, 0}, {4, 0}, {0, 4}, {10, 10}});
  for (Delaunay::Index t = 0; t < delaunay.triangles().size(); ++t) {
    const auto& corners = delaunay.triangles()[t].corners;
    const bool is_corner = corners[2] == 2 || corners[1] == 2 || corners[0] == 2;
    const bool at_origin = std::count(corners.begin(), corners.end(), 0u) == 1;
    const bool finite = delaunay.triangles()[t].is_finite();
    CHECK(delaunay.surely_holds(t, {1, 1}) == (finite && at_origin && is_corner));
    CHECK_FALSE(delaunay.surely_holds(t, {0, 4}));
    CHECK_FALSE(delaunay.surely_holds(t, {100, 0}));
  }
  CHECK_FALSE(delaunay.surely_holds(0, {4, 4}));  // on the circle of the first three
}

TEST_CASE("delaunay: predicates are exact where rounding would decide") {
  // An orientation below half a unit in the last place, as in Kettner et al. (2008).
  const double ulp = std::ldexp(1.0, -53);
  int wrong = 0, left = 0;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec2d p(0.5 + i * ulp, 0.5 + j * ulp);
      const int expected = j > i ? 1 : j < i ? -1 : 0;
      wrong += orientation({12, 12}, {24, 24}, p) != expected;
      left += expected > 0;
    }
  }
  CHECK(wrong == 0);
  CHECK(left > 1000);
  CHECK(in_circle({0, 0}, {1, 0}, {0, 1}, {1, 1}) == 0);
  CHECK(in_circle({0, 0}, {1, 0}, {0, 1}, {1, std::nextafter(1.0, 0.0)}) == 1);
  CHECK(in_circle({0, 0}, {1, 0}, {0, 1}, {1, std::nextafter(1.0, 2.0)}) == -1);
  // Of so small a size that every product underflows.
  const double tiny = 5e-324;
  CHECK(orientation({0, 0}, {tiny, 0}, {0, tiny}) == 1);
  CHECK(orientation({0, 0}, {0, tiny}, {tiny, 0}) == -1);
  CHECK(in_circle({0, 0}, {2 * tiny, 0}, {0, 2 * tiny}, {tiny, tiny}) == 1);
  CHECK(in_circle({0, 0}, {2 * tiny, 0}, {0, 2 * tiny}, {2 * tiny, 2 * tiny}) == 0);
}

}  // namespace pprt::delaunay_test
