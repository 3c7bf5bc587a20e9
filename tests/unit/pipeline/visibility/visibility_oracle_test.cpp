// The visibility buffer against what each primitive's formula says, point by point, of random shapes.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "pipeline/visibility/visibility_buffer.h"

namespace pprt::visibility_oracle_test {
namespace {

constexpr int kWidth = 88, kHeight = 41;  // tiles of 16 pixels: more columns than rows, none whole at the end
constexpr int kPrimitives = 24;

// How near a shape is at a point, by image_shape.h; 0 where it is not.
double nearness_of(const ImageShape& shape, double x, double y) {
  double most = 0;
  if (shape.kind == ImageShape::Kind::kFacets) {
    for (const ImageFacet& f : shape.facets) {
      bool is_in = true;
      for (const LinearForm& edge : f.edges) is_in = is_in && edge.at(x, y) >= 0;
      if (is_in) most = std::max(most, f.nearness.at(x, y));
    }
    return most;
  }
  const ImageQuadric& q = shape.quadric;
  const double discriminant = q.discriminant.at(x, y);
  if (discriminant <= 0) return 0;
  for (const bool is_front : {true, false}) {
    if (!(is_front ? q.front : q.back)) continue;
    const double n = -q.middle.at(x, y) + (is_front ? 1 : -1) * std::sqrt(discriminant);
    const double height = q.height + q.along.at(x, y) / n;
    if (n > most && (!q.has_ends || (height >= 0 && height <= q.top))) most = n;
  }
  return most;
}

class RandomShapes {
 public:
  explicit RandomShapes(unsigned seed) : random_(seed), surfaces_(1, 0) {
    for (std::uint32_t i = 1; i <= kPrimitives; ++i) {
      shapes_.push_back(i % 2 == 0 ? facets() : quadric());
      surfaces_.push_back(i % 5 == 0 ? i - 2 : i);  // some are parts of one surface
    }
  }

  PrimitiveShapes shapes() const {
    return {[this](std::uint32_t p, ImageShape& to) { to = shapes_.at(p - 1); }, kPrimitives, surfaces_, {}};
  }
  std::uint32_t surface_of(std::uint32_t primitive) const { return surfaces_.at(primitive); }
  double nearness(std::uint32_t primitive, double x, double y) const {
    return primitive == 0 ? 0 : nearness_of(shapes_.at(primitive - 1), x, y);
  }
  std::uint32_t nearest(double x, double y) const {
    std::uint32_t found = 0;
    for (std::uint32_t p = 1; p <= kPrimitives; ++p)
      if (nearness(p, x, y) > nearness(found, x, y)) found = p;
    return found;
  }
  // The primitive seen at a point and next to it; nothing where two meet.
  std::optional<std::uint32_t> seen(double x, double y) const {
    constexpr double kNext = 0.004;
    const std::uint32_t found = nearest(x, y);
    for (const double v : {-kNext, kNext})
      for (const double u : {-kNext, kNext})
        if (nearest(x + u, y + v) != found) return std::nullopt;
    return found;
  }
  double any(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }

 private:
  LinearForm slope() {
    const double per_x = any(-0.02, 0.02), per_y = any(-0.02, 0.02);
    return {any(0.5, 4) - per_x * kWidth / 2 - per_y * kHeight / 2, per_x, per_y};
  }
  // Three triangles of any size, some far beyond the picture.
  ImageShape facets() {
    ImageShape shape;
    shape.kind = ImageShape::Kind::kFacets;
    const double x = any(0, kWidth), y = any(0, kHeight), size = std::exp(any(0, 4.5));
    for (int i = 0; i < 3; ++i) {
      std::array<Vec2d, 3> corners;
      for (Vec2d& corner : corners) corner = Vec2d(x + any(-size, size), y + any(-size, size));
      const Vec2d a = corners[1] - corners[0], b = corners[2] - corners[0];
      if (a.x * b.y - a.y * b.x < 0) std::swap(corners[1], corners[2]);
      ImageFacet& facet = shape.facets.emplace_back();
      facet.bounds = {1e9F, 1e9F, -1e9F, -1e9F};
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec2d &from = corners[k], &to = corners[(k + 1) % 3];
        facet.edges[k] = {from.x * to.y - from.y * to.x, from.y - to.y, to.x - from.x};
        const auto u = static_cast<float>(from.x), v = static_cast<float>(from.y);
        facet.bounds = around(facet.bounds, {u, v, u, v});
      }
      facet.nearness = slope();
    }
    return shape;
  }
  // An ellipsoid of any size; some are open at the ends of an axis, some show one face only.
  ImageShape quadric() {
    ImageShape shape;
    shape.kind = ImageShape::Kind::kQuadric;
    ImageQuadric& q = shape.quadric;
    const double x = any(0, kWidth), y = any(0, kHeight), size = std::exp(any(0.5, 3.5));
    const double a = 1 / (size * size), c = a * any(0.5, 2), b = any(-1, 1) * std::sqrt(a * c),
                 deep = any(0.1, 1);
    // deep^2 (1 - a u^2 - b u v - c v^2) about the place (x, y).
    const double d = deep * deep;
    q.discriminant = {d * (1 - a * x * x - b * x * y - c * y * y),
                      d * (2 * a * x + b * y),
                      d * (2 * c * y + b * x),
                      -d * a,
                      -d * b,
                      -d * c};
    const LinearForm at = slope();
    q.middle = {-at.constant, -at.per_x, -at.per_y};
    q.has_ends = any(0, 1) < 0.6;
    const double per_x = any(-1, 1) / size, per_y = any(-1, 1) / size;
    q.along = {-per_x * x - per_y * y, per_x, per_y};
    q.height = any(0, 0.3), q.top = any(0.3, 1);
    q.front = any(0, 1) < 0.8, q.back = !q.front || any(0, 1) < 0.6;
    const double along_x = std::sqrt(4 * c / (4 * a * c - b * b)),
                 along_y = std::sqrt(4 * a / (4 * a * c - b * b));
    q.bounds = {static_cast<float>(x - along_x), static_cast<float>(y - along_y),
                static_cast<float>(x + along_x), static_cast<float>(y + along_y)};
    return shape;
  }

  std::mt19937 random_;
  std::vector<ImageShape> shapes_;
  std::vector<std::uint32_t> surfaces_;
};

}  // namespace

TEST_CASE("visibility buffer: at every point it sees what formulas say of random shapes") {
  const unsigned seed = GENERATE(1U, 2U);
  const auto fineness = GENERATE(VisibilityBuffer::kCoarse, VisibilityBuffer::kFine);
  RandomShapes scene(seed);
  VisibilityBuffer buffer(kWidth, kHeight, scene.shapes());
  buffer.forget(fineness);
  REQUIRE(buffer.is_known());
  const int side = fineness.points_per_side;
  int known = 0, wrong = 0, wrong_in_middle = 0;
  std::set<std::uint32_t> seen;
  for (int y = 0; y <= side * kHeight; ++y) {
    for (int x = 0; x <= side * kWidth; ++x) {
      const auto primitive = scene.seen(static_cast<double>(x) / side, static_cast<double>(y) / side);
      if (!primitive) continue;
      ++known, seen.insert(*primitive);
      wrong += buffer.at(x, y) != scene.surface_of(*primitive) ? 1 : 0;
      if (x % side == side / 2 && y % side == side / 2 && x < side * kWidth && y < side * kHeight)
        wrong_in_middle += buffer.primitive_in_middle(x / side, y / side) != *primitive ? 1 : 0;
    }
  }
  INFO("scene " << seed << ", points a side " << side);
  CHECK((wrong == 0 && wrong_in_middle == 0));
  CHECK(known > 0.95 * (side * kWidth + 1) * (side * kHeight + 1));
  CHECK(seen.size() > kPrimitives / 2);
}

TEST_CASE("visibility buffer: between its points the nearest of what they see is found, and its surface") {
  RandomShapes scene(GENERATE(1U, 2U));
  VisibilityBuffer buffer(kWidth, kHeight, scene.shapes());
  REQUIRE(buffer.is_known());
  int edges = 0, wrong = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    const Vec2d at(scene.any(0, kWidth), scene.any(0, kHeight));
    const double x = std::floor(4 * at.x) / 4, y = std::floor(4 * at.y) / 4;
    std::array<std::optional<std::uint32_t>, 4> around = {
        scene.seen(x, y), scene.seen(x + 0.25, y), scene.seen(x, y + 0.25), scene.seen(x + 0.25, y + 0.25)};
    if (std::count(around.begin(), around.end(), std::nullopt) > 0) continue;
    std::uint32_t nearest = 0;
    for (const auto& p : around)
      if (scene.nearness(*p, at.x, at.y) > scene.nearness(nearest, at.x, at.y)) nearest = *p;
    const bool is_edge = std::count(around.begin(), around.end(), around[0]) != 4;
    edges += is_edge ? 1 : 0;
    // Where one primitive is all around, it is taken to be seen between the points.
    const std::uint32_t expected = is_edge ? nearest : *around[0];
    bool is_clear = true;  // not next to another's edge
    for (const auto& p : around)
      for (const double u : {-0.004, 0.004})
        for (const double v : {-0.004, 0.004})
          is_clear = is_clear && (*p == expected || scene.nearness(*p, at.x + u, at.y + v) <=
                                                        scene.nearness(expected, at.x + u, at.y + v));
    if (is_clear) wrong += buffer.at(at) != scene.surface_of(expected) ? 1 : 0;
    for (const auto& p : around) {
      const std::uint32_t found = buffer.primitive_at(at, scene.surface_of(*p));
      wrong += scene.surface_of(found) != scene.surface_of(*p) ||
                       std::count(around.begin(), around.end(), found) == 0
                   ? 1
                   : 0;
    }
    wrong += buffer.primitive_at(at, kPrimitives + 1) != 0 ? 1 : 0;
  }
  CHECK(wrong == 0);
  CHECK(edges > 100);
}

TEST_CASE("visibility buffer: shares of random shapes in a pixel are those of their areas") {
  const unsigned seed = GENERATE(1U, 2U);
  const bool is_refined = GENERATE(false, true);
  RandomShapes scene(seed);
  VisibilityBuffer buffer(kWidth, kHeight, scene.shapes());
  REQUIRE(buffer.is_known());
  if (is_refined) buffer.refine_shares();
  int mixed = 0;
  double worst = 0, sum = 0, missed = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const VisibleTile& tile = buffer.tile(x, y);
      const SeenInPixel& seen = buffer.seen_in(x, y);
      if (seen.count < 2) continue;
      ++mixed;
      constexpr int kSide = 24;
      std::map<std::uint32_t, double> areas;
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i)
          areas[scene.nearest(x + (i + 0.5) / kSide, y + (j + 0.5) / kSide)] += 1.0 / (kSide * kSide);
      for (std::size_t k = 0; k < seen.count; ++k) {
        double& area = areas[tile.primitive(seen.numbers[k])];
        const double error = std::abs(seen.shares[k] - area);
        worst = std::max(worst, error), sum += error * error;
        area = 0;
      }
      for (const auto& [primitive, area] : areas) missed = std::max(missed, area);
    }
  }
  INFO("scene " << seed << ", refined " << is_refined);
  REQUIRE(mixed > 300);
  CHECK(worst < (is_refined ? 0.05 : 0.1));
  CHECK(std::sqrt(sum / mixed) < (is_refined ? 0.015 : 0.03));
  CHECK(missed < 0.05);
}

}  // namespace pprt::visibility_oracle_test
