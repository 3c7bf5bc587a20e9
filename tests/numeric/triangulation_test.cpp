// A million hard points in the triangulation, checked in exact arithmetic.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "numeric/report.h"
#include "pipeline/mesh/reconstruction.h"
#include "pipeline/mesh/sample_mesh.h"
#include "unit/pipeline/cgal_oracle.h"

namespace pprt::triangulation_test {
namespace {

const TileGrid kGrid{256, 192, 4};

// All coordinates are multiples of this step, some 1e-12 pixels. As integers they are below 2^48, so an
// orientation (a sum of products of differences) is below 2^100.
constexpr double kStep = 0x1p-40;
__extension__ using Exact = __int128;

// Returns twice the area in square steps.
Exact orientation(const Sample& a, const Sample& b, const Sample& c) {
  const auto steps = [](double difference) { return static_cast<Exact>(difference / kStep); };
  return steps(b.x - a.x) * steps(c.y - a.y) - steps(b.y - a.y) * steps(c.x - a.x);
}

// Stays in one neighbourhood for a while, as sampling does, so that point location costs little.
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

// Returns how far a point lies outside a triangle, pixels; negative inside.
double outside_by(const SampleMesh& mesh, const std::array<std::uint32_t, 3>& corners, const Sample& point) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Sample &a = mesh.samples()[corners[k]], &b = mesh.samples()[corners[(k + 1) % 3]];
    const double twice = static_cast<double>(orientation(a, b, point)) * kStep * kStep;
    most = std::max(most, -twice / std::hypot(b.x - a.x, b.y - a.y));
  }
  return most;
}

// Returns how far a pixel's centre lies outside its triangle at most; infinite when a pixel has none.
double farthest_center(const SampleMesh& mesh) {
  const auto corners = triangles(mesh);
  const std::vector<std::uint32_t> at = triangle_at_centers(mesh, {0, 0, kGrid.width, kGrid.height});
  double most = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (at[i] == kNoTriangle) return std::numeric_limits<double>::infinity();
    const auto x = static_cast<int>(i) % kGrid.width, y = static_cast<int>(i) / kGrid.width;
    most = std::max(most, outside_by(mesh, corners[at[i]], sample_at({x + 0.5, y + 0.5})));
  }
  return most;
}

// Checks that the finite triangles tile the image: each turns left, and their areas add up exactly.
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

TEST_CASE("a million hard points leave a valid triangulation") {
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
  const double outside = farthest_center(mesh);
  CHECK(outside < 1e-12);
  test::report("a million grid points, duplicates, border points and neighbours 2^-40 of a pixel apart",
               "areas add up exactly, every triangle turns left",
               "exact predicates; judged in integers of 128 bits",
               turned == 0 ? "exact" : fmt::format("{} turned", turned));
  test::report("of these, the triangle at each pixel's centre",
               "there is one, and it holds the centre to 1e-12 pixels",
               "edges cross a row at a place that is rounded to 2^-45",
               fmt::format("{:.1g} pixels", outside));
}

// Points along the border and around a circle are so near to a line or a circle that circumcentres lie
// anywhere.
TEST_CASE("refinement among slivers asks for distinct points of the image and leaves a valid triangulation") {
  constexpr int kRefined = 50'000;
  SampleMesh mesh(Region::whole(kGrid));
  const auto put = [&](double x, double y) {
    Sample sample = sample_at({x, y});
    sample.ray.color = Color(std::fmod(static_cast<float>(x), 2.0f), 0, static_cast<float>(x > y));
    return mesh.insert(sample);
  };
  for (const Vec2d& corner : {Vec2d(0, 0), Vec2d(256, 0), Vec2d(256, 192), Vec2d(0, 192)})
    put(corner.x, corner.y);
  for (int i = 1; i < 1000; ++i) {
    const double along = i / 4.0, off = kStep * (1 + i % 3);
    put(along, off), put(along, 192 - off), put(along, 96 + off), put(off, std::min(along, 191.0));
    const double angle = i * 0.0062831853;  // a circle, rounded
    put(std::round((128 + 64 * std::cos(angle)) / kStep) * kStep,
        std::round((96 + 64 * std::sin(angle)) / kStep) * kStep);
  }
  int outside = 0, refused = 0;
  for (int i = 0; i < kRefined; ++i) {
    const std::optional<Refinement> next = mesh.next_point();
    REQUIRE(next);
    const Vec2d& point = next->point;
    outside += !(point.x >= 0 && point.y >= 0 && point.x <= kGrid.width && point.y <= kGrid.height);
    refused += !put(point.x, point.y);
  }
  CHECK(outside == 0);
  CHECK(refused == 0);
  CHECK(std::isfinite(mesh.mean_weight()));
  // Circumcentres are no multiples of the step, so areas are summed in long double.
  long double area = 0;
  for (const auto& t : triangles(mesh)) {
    const Sample &a = mesh.samples()[t[0]], &b = mesh.samples()[t[1]], &c = mesh.samples()[t[2]];
    const auto difference = [](double from, double to) { return static_cast<long double>(to) - from; };
    area += difference(a.x, b.x) * difference(a.y, c.y) - difference(a.y, b.y) * difference(a.x, c.x);
  }
  const double missing = std::abs(static_cast<double>(area - 2.0L * kGrid.width * kGrid.height));
  CHECK(missing < 1e-9);
  test::report(fmt::format("{} refinements amid slivers along borders and circles", kRefined),
               "every point asked for lies in the image and is new; areas add up to 1e-9 pixels",
               "200,000 sums of long double",
               outside + refused == 0 ? fmt::format("so; {:.1g} pixels", missing) : "not");
}

TEST_CASE("a picture of one colour is reconstructed exactly from hard points, by every rule") {
  const Color color(0.1f, 1 / 3.0f, 0.7f);
  SampleMesh mesh(Region::whole(kGrid));
  const auto put = [&](const Vec2d& p) {
    Sample sample = sample_at(p);
    sample.ray.color = color;
    mesh.insert(sample);
  };
  for (const Vec2d& corner : {Vec2d(0, 0), Vec2d(256, 0), Vec2d(256, 192), Vec2d(0, 192)}) put(corner);
  HardPoints points;
  for (int i = 0; i < 30'000; ++i) put(points.next());
  std::ptrdiff_t others = 0;
  for (const PixelRule rule : {PixelRule::kCenter, PixelRule::kMean, PixelRule::kArea}) {
    PixelBlock pixels;
    ReconstructionBuffers buffers;
    reconstruct(mesh, mesh.region().bounds(), pixels, buffers, rule);
    others +=
        std::count_if(pixels.colors.begin(), pixels.colors.end(), [&](const Color& c) { return c != color; });
  }
  CHECK(others == 0);
  test::report("a picture of one colour from 30,000 hard points, by every rule for pixels", "exact",
               "differences are 0", others == 0 ? "exact" : fmt::format("{} pixels", others));
}

}  // namespace pprt::triangulation_test
