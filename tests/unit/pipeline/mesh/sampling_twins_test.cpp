// The vector routines of sampling against their scalar twins, to the bit.
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "pipeline/mesh/circumcircle.h"
#include "pipeline/mesh/delaunay.h"
#include "pipeline/mesh/fan_weights.h"
#include "unit/pipeline/mesh/fan_weights_scalar.h"

namespace pprt::sampling_twins_test {
namespace {

// Random points with a row of nearly collinear ones among them, whose triangles have hardly any area.
Vec2d random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> anywhere(0, 200);
  const double x = anywhere(random);
  return random() % 4 == 0 ? Vec2d(x, 50 + 1e-9 * anywhere(random)) : Vec2d(x, anywhere(random));
}

// Dark, bright and beyond the display scale; on a few primitives.
MeshCorner random_corner(std::mt19937& random) {
  std::uniform_real_distribution<float> channel(-0.25F, 1.5F);
  MeshCorner corner;
  corner.color = Color(channel(random), channel(random), channel(random));
  if (random() % 3 == 0) corner.color = Color(0.5F, 0.5F, 0.5F);
  corner.primitive = static_cast<std::uint32_t>(random() % 3);
  corner.feature = feature_of(std::exp2(-static_cast<float>(random() % 20)), 1U << random() % 6);
  return corner;
}

// Calls inspect(mesh) after each of many insertions.
template <class Inspect>
void insert_many(std::uint32_t seed, const Inspect& inspect) {
  std::mt19937 random(seed);
  Delaunay mesh;
  std::vector<MeshCorner> corners;
  for (int i = 0; i < 600; ++i) {
    const Vec2d point = random_point(random);
    const bool was_planar = mesh.is_planar();
    if (!was_planar) {
      if (!mesh.insert_before_planar(point)) continue;
    } else {
      const Delaunay::Index at = mesh.locate(point, 0);
      if (at == Delaunay::kNowhere) continue;
      mesh.insert(point, at);
    }
    corners.push_back(random_corner(random));
    if (was_planar) inspect(mesh, corners);
  }
}

struct Comparison {
  int compared = 0, different = 0;
};

bool is_same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

template <class Twin>
Comparison compare_circles(const Twin& twin) {
  Comparison result;
  insert_many(3, [&](const Delaunay& mesh, const std::vector<MeshCorner>&) {
    for (const Delaunay::Index i : mesh.new_triangles()) {
      const Delaunay::Triangle& t = mesh.triangles()[i];
      if (!t.is_finite()) continue;
      const auto& [a, b, c] = t.corners;
      const auto& points = mesh.points();
      const Circumcircle expected = twin(points[a] - points[c], points[b] - points[c]);
      ++result.compared;
      result.different += !is_same(t.circle.diameter_x, expected.diameter_x) ||
                          !is_same(t.circle.diameter_y, expected.diameter_y) ||
                          !is_same(t.circle.slack, expected.slack) ||
                          !is_same(t.circle.size_squared, expected.size_squared);
    }
  });
  return result;
}

template <class Twin>
Comparison compare_weights(const WeightTerms& terms, const Twin& twin) {
  Comparison result;
  FanWeights weights;
  insert_many(5, [&](const Delaunay& mesh, const std::vector<MeshCorner>& corners) {
    weights.compute(mesh, corners, terms);
    const auto boundary = mesh.boundary_corners();
    for (std::size_t k = 0; k < boundary.size(); ++k) {
      const Delaunay::Triangle& t = mesh.triangles()[mesh.new_triangles()[k]];
      if (!t.is_finite()) continue;
      const MeshCorner &corner = corners[boundary[k]], &next = corners[boundary[(k + 1) % boundary.size()]];
      const scalar::FanWeight expected = twin(corner, next, corners.back(), t.circle.size_squared, terms);
      ++result.compared;
      result.different += !is_same(weights.weight(k), expected.weight) || weights.bin(k) != expected.bin;
    }
  });
  return result;
}

}  // namespace

TEST_CASE("scalar twin: circumcircles of four triangles are those of one at a time, to the bit") {
  const Comparison right = compare_circles(circumcircle);
  CHECK(right.compared > 2000);
  CHECK(right.different == 0);
  // Controls: the third corner in the place of another, and a bound that is off by its last bit.
  const Comparison turned =
      compare_circles([](const Vec2d& a, const Vec2d& b) { return circumcircle(b - a, -a); });
  CHECK(turned.different > turned.compared / 2);
  const Comparison off = compare_circles([](const Vec2d& a, const Vec2d& b) {
    Circumcircle circle = circumcircle(a, b);
    circle.slack = std::nextafter(circle.slack, 0.0F);
    return circle;
  });
  CHECK(off.different == off.compared);
}

TEST_CASE("scalar twin: weights and bins of a fan are those of one triangle at a time, to the bit") {
  for (const WeightTerms& terms : {WeightTerms{}, WeightTerms{.area = false}, WeightTerms{.variance = false},
                                   WeightTerms{.pixel_rule = false}}) {
    const Comparison right = compare_weights(terms, scalar::fan_weight);
    CHECK(right.compared > 2000);
    CHECK(right.different == 0);
  }
  // Controls: the boundary's corners shifted by one, and a weight that is off by its last bit.
  const Comparison shifted =
      compare_weights({}, [](const MeshCorner& corner, const MeshCorner& next, const MeshCorner& apex,
                             float size_squared, const WeightTerms& terms) {
        return scalar::fan_weight(next, apex, corner, 2 * size_squared, terms);
      });
  CHECK(shifted.different > shifted.compared / 2);
  const Comparison off =
      compare_weights({}, [](const MeshCorner& corner, const MeshCorner& next, const MeshCorner& apex,
                             float size_squared, const WeightTerms& terms) {
        scalar::FanWeight twin = scalar::fan_weight(corner, next, apex, size_squared, terms);
        twin.weight = std::nextafter(twin.weight, 1e9F);
        return twin;
      });
  CHECK(off.different == off.compared);
}

}  // namespace pprt::sampling_twins_test
