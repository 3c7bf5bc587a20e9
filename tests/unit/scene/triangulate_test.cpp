#include "scene/triangulate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace pprt;

namespace {

double area(std::span<const Vec3d> polygon) {
  return 0.5 * newell_normal(polygon).length();
}

// Every triangle turned the polygon's way, and all of them together as large as it: no overlap, no gap.
void check_cover(const std::vector<Vec3d>& polygon) {
  const Vec3d normal = newell_normal(polygon);
  double sum = 0;
  for (const TriangleIndices& t : triangulate(polygon)) {
    const Vec3d n = (polygon[t[1]] - polygon[t[0]]).cross(polygon[t[2]] - polygon[t[0]]);
    CHECK(n.dot(normal) > 0);
    sum += 0.5 * n.length();
  }
  CHECK(sum == Approx(area(polygon)).epsilon(1e-12));
}

bool inside(const std::vector<Vec3d>& polygon, double x, double y) {
  bool in = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Vec3d &a = polygon[i], &b = polygon[j];
    if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

bool inside(const Vec3d& a, const Vec3d& b, const Vec3d& c, double x, double y) {
  const auto side = [&](const Vec3d& p, const Vec3d& q) {
    return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
  };
  return side(a, b) > 0 && side(b, c) > 0 && side(c, a) > 0;
}

std::vector<Vec3d> star(int points, double inner) {
  std::vector<Vec3d> polygon;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points;
    const double radius = i % 2 == 0 ? 1 : inner;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return polygon;
}

}  // namespace

TEST_CASE("convex and concave polygons are covered once") {
  check_cover({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  check_cover({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  check_cover({{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}});  // an arrow head
  check_cover({{0, 0, 5}, {3, 0, 5}, {3, 3, 5}, {2, 3, 5}, {2, 1, 5}, {1, 1, 5}, {1, 3, 5}, {0, 3, 5}});
  check_cover(star(5, 0.3));
  check_cover(star(72, 0.9));
  check_cover(star(200, 0.05));
}

TEST_CASE("a polygon is covered in any plane and either winding") {
  const std::vector<Vec3d> flat = star(7, 0.4);
  for (int i = 0; i < 12; ++i) {
    const double a = 0.5 * i + 0.1;
    std::vector<Vec3d> turned;
    for (const Vec3d& p : flat) {
      const Vec3d q(p.x * std::cos(a) - p.y * std::sin(a), p.x * std::sin(a) + p.y * std::cos(a), 0);
      turned.emplace_back(q.x * std::cos(2 * a) + 3, q.y + 1e3, q.x * std::sin(2 * a) - 2);
    }
    check_cover(turned);
    check_cover({turned.rbegin(), turned.rend()});
  }
}

TEST_CASE("the triangles of a comb hold exactly the points that the comb holds") {
  std::vector<Vec3d> comb = {{0, 0, 0}, {10, 0, 0}};
  for (int tooth = 9; tooth >= 0; --tooth) {
    comb.emplace_back(tooth + 0.9, 5 + tooth % 3, 0);
    comb.emplace_back(tooth + 0.5, 1, 0);
  }
  const auto triangles = triangulate(comb);
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> u(-0.5, 10.5);
  int in = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = u(engine), y = u(engine);
    int covering = 0;
    for (const TriangleIndices& t : triangles) covering += inside(comb[t[0]], comb[t[1]], comb[t[2]], x, y);
    REQUIRE(covering == (inside(comb, x, y) ? 1 : 0));
    in += covering;
  }
  CHECK(in > 1000);
}

TEST_CASE("duplicate and collinear vertices take no triangle and leave no hole") {
  check_cover(
      {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
  const std::vector<Vec3d> square = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {0, 2, 0}};
  check_cover(square);
  CHECK(triangulate(square).size() <= 4);
  // A whisker: out along an edge and back again.
  check_cover({{0, 0, 0}, {2, 0, 0}, {3, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
}

TEST_CASE("triangulation ends for any polygon") {
  CHECK(triangulate({}).empty());
  const std::vector<Vec3d> line = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  CHECK(triangulate(line).empty());
  const std::vector<Vec3d> point(5, Vec3d(1, 2, 3));
  CHECK(triangulate(point).empty());
  const std::vector<Vec3d> bow_tie = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 3, 0}};
  CHECK(triangulate(bow_tie).size() <= 2);
  const std::vector<Vec3d> saddle = {{0, 0, 0}, {1, 0, 0.3}, {1, 1, 0}, {0, 1, 0.3}};
  CHECK(triangulate(saddle).size() == 2);
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3d> scribble;
    for (int k = 0; k < 4 + i % 30; ++k) scribble.emplace_back(u(engine), u(engine), u(engine));
    CHECK(triangulate(scribble).size() <= scribble.size() - 2);
  }
}
