// A million hard points in the triangulation, judged in exact arithmetic.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cgal_oracle.h"
#include "pipeline/sample_mesh.h"

namespace pprt {
namespace {

const TileGrid kGrid{256, 192, 4};

// All coordinates are multiples of this, some 1e-12 pixels: below 2^48 as integers, so that an orientation
// (products of differences) is below 2^100.
constexpr double kStep = 0x1p-40;
__extension__ using Exact = __int128;

// Twice the area in square steps.
Exact orientation(const Sample& a, const Sample& b, const Sample& c) {
  const auto steps = [](double difference) { return static_cast<Exact>(difference / kStep); };
  return steps(b.x - a.x) * steps(c.y - a.y) - steps(b.y - a.y) * steps(c.x - a.x);
}

// As sampling does, it stays in one neighbourhood for a while: what costs time there is not the way there.
class HardPoints {
 public:
  Vec2d next() {
    if (made_++ % 512 == 0) {
      left_ = static_cast<int>(random_() % static_cast<unsigned>(kGrid.width / kWindow)) * kWindow;
      top_ = static_cast<int>(random_() % static_cast<unsigned>(kGrid.height / kWindow)) * kWindow;
    }
    const unsigned kind = random_() % 8;
    if (kind == 0) return previous_;  // a duplicate
    if (kind <= 2) return previous_ = Vec2d(left_ + eighths(), top_ + eighths());
    if (kind <= 4) {
      return previous_ = Vec2d(step_away(previous_.x, kGrid.width), step_away(previous_.y, kGrid.height));
    }
    if (kind == 5) return previous_ = on_border();
    return previous_ = Vec2d(left_ + anywhere(), top_ + anywhere());
  }

 private:
  static constexpr int kWindow = 8;  // pixels

  double eighths() { return static_cast<double>(random_() % (8 * kWindow + 1)) / 8; }
  double anywhere() {
    return std::floor(std::uniform_real_distribution<double>(0, kWindow)(random_) / kStep) * kStep;
  }
  double step_away(double from, int limit) {
    const double to = from + kStep * (static_cast<double>(random_() % 5) - 2);
    return to >= 0 && to <= limit ? to : from;
  }
  Vec2d on_border() {
    const double x = left_ + anywhere(), y = top_ + anywhere();
    const std::array<Vec2d, 4> sides = {Vec2d(x, 0), Vec2d(kGrid.width, y), Vec2d(x, kGrid.height),
                                        Vec2d(0, y)};
    return sides[random_() % 4];
  }

  std::mt19937 random_{1};
  int made_ = 0;
  int left_ = 0, top_ = 0;  // of the neighbourhood, pixels
  Vec2d previous_{1, 1};
};

Sample sample_at(const Vec2d& p) {
  Sample sample;
  sample.x = p.x, sample.y = p.y;
  return sample;
}

// Whether the finite triangles tile the image: each turns to the left, and their areas add up exactly.
void check_tiling(const SampleMesh& mesh) {
  Exact area = 0;
  std::size_t turned = 0, count = 0;
  for (const auto& t : triangles(mesh)) {
    const Exact twice = orientation(mesh.samples()[t[0]], mesh.samples()[t[1]], mesh.samples()[t[2]]);
    turned += twice <= 0;
    area += twice;
    ++count;
  }
  std::size_t on_border = 0;
  for (const Sample& s : mesh.samples()) {
    on_border += s.x == 0 || s.y == 0 || s.x == kGrid.width || s.y == kGrid.height;
  }
  CHECK(turned == 0);
  const auto image = orientation(sample_at({0, 0}), sample_at({256, 0}), sample_at({256, 192}));
  CHECK((area == 2 * image));
  CHECK(count == 2 * mesh.samples().size() - 2 - on_border);  // Euler: every border point is on the hull
}

}  // namespace

TEST_CASE("a million hard points leave the triangulation whole") {
  constexpr int kPoints = 1'000'000;
  SampleMesh mesh(Region(kGrid, {}));  // of a region that holds nothing every triangle is told
  for (const Vec2d& corner : {Vec2d(0, 0), Vec2d(256, 0), Vec2d(256, 192), Vec2d(0, 192)}) {
    REQUIRE(mesh.insert(sample_at(corner)));
  }
  HardPoints points;
  int refused = 0;
  std::size_t turned = 0;
  std::vector<BorderTriangle> created;
  for (int i = 1; i <= kPoints; ++i) {
    if (!mesh.insert(sample_at(points.next()))) {
      ++refused;
      continue;
    }
    mesh.take_new_at_border(created);
    for (const MeshTriangle& t : created) {
      const auto& [a, b, c] = t.corners;
      turned += orientation(mesh.samples()[a], mesh.samples()[b], mesh.samples()[c]) <= 0;
    }
    if (i == 1000 || i == 30'000) check_tiling(mesh);
  }
  CHECK(turned == 0);
  CHECK(mesh.samples().size() + static_cast<std::size_t>(refused) == 4u + kPoints);
  CHECK(refused > kPoints / 8);
  check_tiling(mesh);

  std::vector<Vec2d> accepted;
  for (const Sample& s : mesh.samples()) accepted.emplace_back(s.x, s.y);
  std::set<TriangleKey> ours;
  for (const auto& t : triangles(mesh))
    ours.insert(triangle_key({accepted[t[0]], accepted[t[1]], accepted[t[2]]}));
  CHECK((ours == cgal_triangles(accepted)));
}

}  // namespace pprt
