// Surfaces between the nodes of a lattice: found, sampled, shown.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "pipeline/lattice/lattice_refiner.h"

namespace pprt::unsampled_surfaces_test {
namespace {

constexpr int kSize = 64;

// Twigs, half a pixel wide, that pass between the nodes of the coarsest grid: x from kFirst + 8 i on.
constexpr double kFirst = 2.2, kWidth = 0.6;

bool is_on_twig(double x) {
  const double from = std::fmod(x, 8) - kFirst;
  return from >= 0 && from <= kWidth;
}

std::uint32_t primitive_at(double x) {
  return is_on_twig(x) ? 2 + static_cast<std::uint32_t>(x / 8) : 1;
}

RaySample sample_at(double x) {
  RaySample sample;
  sample.primitive = primitive_at(x);
  sample.color = sample.primitive == 1 ? Color(0.9F, 0.9F, 0.9F) : Color(0.1F, 0.2F, 0);
  return sample;
}

void add_strip(double x0, double x1, double nearness, ImageShape& shape) {
  const auto box = ImageBounds{static_cast<float>(x0), -1, static_cast<float>(x1), 1000};
  shape.facets.push_back({{{{-x0, 1, 0}, {x1, -1, 0}, {1, 0, 0}}}, {nearness, 0, 0}, box});
}

PrimitiveShapes shapes() {
  return {[](std::uint32_t primitive, ImageShape& shape) {
            shape.kind = ImageShape::Kind::kFacets;
            shape.facets.clear();
            if (primitive == 1) return add_strip(-10, kSize + 10, 1, shape);
            const double left = 8 * (primitive - 2.0) + kFirst;
            add_strip(left, left + kWidth, 2, shape);
          },
          1 + kSize / 8};
}

// Returns a picture of so many samples.
PixelBlock picture(const PrimitiveShapes& known, int samples) {
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}), known);
  for (int i = 0; i < samples; ++i) {
    refiner.expect(samples - i);
    const std::optional<Vec2d> point = refiner.next_point();
    if (!point) break;
    refiner.insert(*point, sample_at(point->x));
  }
  PixelBlock pixels;
  refiner.paint({0, 0, kSize, kSize}, pixels);
  return pixels;
}

double error_of(const PixelBlock& pixels) {
  double sum = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      float mean = 0;
      for (int i = 0; i < 100; ++i) mean += 0.01F * sample_at(x + 0.01 * i + 0.005).color.x;
      sum += (pixels.at(x, y).x - mean) * (pixels.at(x, y).x - mean);
    }
  }
  return std::sqrt(sum / (kSize * kSize));
}

}  // namespace

TEST_CASE(
    "unsampled surfaces: what lies between the nodes is found in each square, with its area and a node on "
    "it") {
  VisibilityBuffer visibility(kSize, kSize, shapes());
  REQUIRE(visibility.is_known());
  SurfaceSamples samples(kSize * kPixelSide, kSize * kPixelSide);
  samples.add({kBaseSide, kBaseSide}, NodeValue(float4{}, 1));
  UnsampledSurfaces unsampled(4);
  const std::span<UnsampledSurface> found = unsampled.find(visibility, samples, {kBaseSide, kBaseSide});
  REQUIRE(found.size() == 1);
  CHECK(found[0].surface == 3);
  CHECK(found[0].area == Approx(8 * kWidth).epsilon(0.3));
  CHECK(is_on_twig(point_of(found[0].node).x));
  samples.add(found[0].node, NodeValue(float4{}, 3));
  CHECK(unsampled.find(visibility, samples, {kBaseSide, kBaseSide}).empty());
}

TEST_CASE("unsampled surfaces: no twig is missed, and each has its colour and place") {
  constexpr int kBaseNodes = 81, kSquares = 64;
  const double known = error_of(picture(shapes(), kBaseNodes + 5 * kSquares));
  const double unknown = error_of(picture({}, kBaseNodes + 5 * kSquares));
  CAPTURE(known, unknown);
  CHECK(known < 0.02);
  CHECK(unknown > 0.1);  // the control: without shapes nobody knows of them
}

}  // namespace pprt::unsampled_surfaces_test
