#include "scene/polygons/triangulate.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

namespace pprt::triangulate_test {

namespace {

double area(std::span<const Vec3d> polygon) {
  return 0.5 * newell_normal(polygon).length();
}

// Every triangle turned the polygon's way, and all of them together as large as it: no overlap, no gap.
// `rounding`: of the sum, relative.
void check_cover(const std::vector<Vec3d>& polygon, double rounding = 1e-12) {
  const Vec3d normal = newell_normal(polygon);
  double sum = 0;
  std::size_t turned = 0;
  for (const TriangleIndices& t : triangulate(polygon)) {
    const Vec3d n = (polygon[t[1]] - polygon[t[0]]).cross(polygon[t[2]] - polygon[t[0]]);
    turned += !(n.dot(normal) > 0);
    sum += 0.5 * n.length();
  }
  CHECK(turned == 0);
  CHECK(sum == Approx(area(polygon)).epsilon(rounding));
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

// A star whose spikes are of random lengths.
std::vector<Vec3d> thistle(int vertices) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> radius(0.05, 1);
  std::vector<Vec3d> polygon;
  for (int i = 0; i < vertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / vertices;
    polygon.push_back(Vec3d(std::cos(angle), std::sin(angle), 0) * radius(engine));
  }
  return polygon;
}

// A comb with teeth of random lengths, upwards and between them downwards.
std::vector<Vec3d> ragged_comb(int teeth) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> length(0, 4);
  std::vector<Vec3d> polygon = {{0, -20, 0}, {10, -20, 0}};
  for (int i = teeth - 1; i >= 0; --i) {
    polygon.emplace_back((i + 0.9) * 10 / teeth, 5 + length(engine), 0);
    polygon.emplace_back((i + 0.5) * 10 / teeth, 1 - length(engine), 0);
  }
  return polygon;
}

// A band that winds round the origin.
std::vector<Vec3d> spiral(int vertices, double turns) {
  std::vector<Vec3d> polygon;
  for (int i = 0; i < vertices; ++i) {
    const bool outward = i < vertices / 2;
    const double share = 2.0 * (outward ? i : vertices - 1 - i) / vertices;
    const double angle = 2 * std::numbers::pi * turns * share, radius = angle + (outward ? 1 : 3);
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return polygon;
}

std::vector<Vec3d> scribble(int vertices, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Vec3d> polygon;
  for (int i = 0; i < vertices; ++i) polygon.emplace_back(u(engine), u(engine), u(engine));
  return polygon;
}

std::vector<Vec3d> scaled(std::vector<Vec3d> polygon, double by) {
  for (Vec3d& p : polygon) p *= by;
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
  for (int i = 0; i < 200; ++i) {
    const std::vector<Vec3d> polygon = scribble(4 + i % 30, static_cast<unsigned>(i));
    CHECK(triangulate(polygon).size() <= polygon.size() - 2);
  }
  const std::vector<Vec3d> large = scribble(5000, 1);
  CHECK(triangulate(large).size() <= large.size() - 2);
}

TEST_CASE("large polygons are covered once at any scale") {
  for (const double scale : {1.0, 1e-30, 1e60}) {
    check_cover(scaled(star(1000, 1), scale));
    check_cover(scaled(star(1500, 0.05), scale));
    check_cover(scaled(thistle(3000), scale));
    check_cover(scaled(ragged_comb(1500), scale));
    check_cover(scaled(spiral(3000, 12), scale), 1e-10);
  }
  // Each vertex of a star four times, and a square of collinear vertices.
  std::vector<Vec3d> repeated, square;
  for (const Vec3d& p : star(300, 0.5)) repeated.insert(repeated.end(), 4, p);
  check_cover(repeated);
  for (int i = 0; i < 500; ++i) square.emplace_back(i, 0, 0);
  for (int i = 0; i < 500; ++i) square.emplace_back(500, i, 0);
  for (int i = 0; i < 500; ++i) square.emplace_back(500 - i, 500, 0);
  for (int i = 0; i < 500; ++i) square.emplace_back(0, 500 - i, 0);
  check_cover(square);
  CHECK(triangulate(square).size() == 2);
}

// By a search through all vertices each of these takes minutes.
TEST_CASE("polygons of 200,000 vertices end within a minute") {
  const auto start = std::chrono::steady_clock::now();
  check_cover(star(100'000, 1));
  check_cover(star(100'000, 0.05));
  check_cover(thistle(200'000));
  check_cover(ragged_comb(100'000));
  check_cover(spiral(200'000, 100), 1e-10);
  CHECK(triangulate(scribble(200'000, 1)).size() <= 199'998);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::minutes(1));
}

}  // namespace pprt::triangulate_test
