// Textures are known between samples: only the light on them is interpolated.
#include "pipeline/lattice/surface_textures.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "unit/pipeline/lattice/refined_picture.h"

namespace pprt::surface_textures_test {
namespace {

constexpr int kSize = 64;

// Two walls that meet at x = kEdge, primitives 1 and 2. Primitive 3 is a pane before them, without a texture.
constexpr double kEdge = 29.3;
constexpr double kPaneLeft = 40.4, kPaneRight = 47.8;

std::uint32_t primitive_at(double x) {
  return x > kPaneLeft && x < kPaneRight ? 3 : x < kEdge ? 1 : 2;
}

// Stripes of three pixels, unlike in their channels.
Color texture_at(double x, double y) {
  const auto wave = [](double at) { return static_cast<float>(0.55 + 0.45 * std::cos(at)); };
  return {wave(2.1 * x), wave(2.1 * y), wave(1.3 * (x + y))};
}

Color light_at(double x, double y) {
  return {static_cast<float>(0.3 + 0.01 * x), 0.8F, static_cast<float>(0.9 - 0.01 * y)};
}

Color color_at(double x, double y) {
  if (primitive_at(x) == 3) return {0.2F, 0.3F, 0.1F};
  return texture_at(x, y) * light_at(x, y);
}

PrimitiveShapes shapes() {
  return {[](std::uint32_t primitive, ImageShape& shape) {
            shape.kind = ImageShape::Kind::kFacets;
            shape.facets.clear();
            const double x0 = primitive == 1 ? -10 : primitive == 2 ? kEdge : kPaneLeft;
            const double x1 = primitive == 1 ? kEdge : primitive == 2 ? kSize + 10 : kPaneRight;
            const auto box = ImageBounds{static_cast<float>(x0), -1, static_cast<float>(x1), 1000};
            shape.facets.push_back(
                {{{{-x0, 1, 0}, {x1, -1, 0}, {1, 0, 0}}}, {primitive == 3 ? 2.0 : 1.0, 0, 0}, box});
          },
          3};
}

constexpr std::array<std::uint8_t, 4> kThere = {0, 1, 1, 0};

// Its means are of per_side x per_side points.
PrimitiveTextures textures() {
  return {kThere, [](std::uint32_t primitive, double x, double y, double side, int per_side) {
            REQUIRE((primitive == 1 || primitive == 2));
            Color sum(0, 0, 0);
            for (int j = 0; j < per_side; ++j) {
              for (int i = 0; i < per_side; ++i)
                sum += texture_at(x + side * ((i + 0.5) / per_side - 0.5),
                                  y + side * ((j + 0.5) / per_side - 0.5));
            }
            return std::optional(sum * (1.0F / static_cast<float>(per_side * per_side)));
          }};
}

PixelBlock picture(const PrimitiveTextures& known, int samples) {
  LatticeRefiner refiner(Region::whole({kSize, kSize, 32}), shapes(), LatticeOrder::kAdaptive, known);
  return test::picture_of(refiner, kSize, samples, [](double x, double y) {
    RaySample sample;
    sample.color = color_at(x, y), sample.primitive = primitive_at(x);
    return sample;
  });
}

double error_of(const PixelBlock& pixels, int from = 0, int to = kSize) {
  return test::error_of(pixels, from, to, color_at);
}

}  // namespace

TEST_CASE("textures: a few samples show a texture that they do not resolve") {
  constexpr int kSamples = 300;  // one for fourteen pixels
  const double known = error_of(picture(textures(), kSamples));
  const double unknown = error_of(picture({}, kSamples));
  CHECK(unknown > 0.15);
  CHECK(known < 0.2 * unknown);
}

TEST_CASE("textures: they show between samples of a pixel, too") {
  CHECK(error_of(picture(textures(), 2000)) < 0.0065);
  CHECK(error_of(picture(textures(), 8000)) < 0.0038);  // two samples a pixel
}

TEST_CASE("textures: they are right up to edges, and what has none is as it was") {
  const PixelBlock pixels = picture(textures(), 600);
  CHECK(error_of(pixels, 0, 28) < 0.01);
  CHECK(error_of(pixels, 28, 31) < 0.02);  // the pixel that two textures share, and those beside it
  CHECK(error_of(pixels, 39, 41) < 0.06);  // a share of the pane
  for (int y = 0; y < kSize; ++y)
    for (int x = 42; x < 47; ++x) REQUIRE((pixels.at(x, y) - Color(0.2F, 0.3F, 0.1F)).length() < 0.02F);
}

TEST_CASE("textures: many samples are right even where a texture is said to be another") {
  PrimitiveTextures wrong = textures();
  wrong.over = [](std::uint32_t, double x, double y, double, int) {
    return std::optional(texture_at(1.4 * y, x) * 0.7F);
  };
  CHECK(error_of(picture(wrong, 20000)) < 0.2 * error_of(picture(wrong, 600)));
  CHECK(error_of(picture(wrong, 20000)) < 0.05);
}

TEST_CASE("textures: they are looked up anew when what is seen is forgotten, and not before") {
  double shift = 0;
  PrimitiveTextures moving = textures();
  moving.over = [&shift](std::uint32_t, double x, double y, double, int) {
    return std::optional(texture_at(x + shift, y));
  };
  VisibilityBuffer visibility(kSize, kSize, shapes());
  REQUIRE(visibility.is_known());
  SurfaceTextures kept(moving, visibility);
  const LatticeNode node{8 * kPixelSide, 8 * kPixelSide};
  const TextureFactor before = kept.at(node, 1);
  REQUIRE(is_known(before));
  shift = 1;
  CHECK(kept.at(node, 1)[0] == before[0]);
  kept.forget();
  CHECK(kept.at(node, 1)[0] == texture_at(9, 8).x);
  CHECK_FALSE(is_known(kept.at({60 * kPixelSide, 8 * kPixelSide}, 1)));  // another surface is there
}

TEST_CASE("textures: the light that is usual fades, and no single sample rules it") {
  VisibilityBuffer visibility(kSize, kSize, shapes());
  REQUIRE(visibility.is_known());
  SurfaceTextures textured(textures(), visibility);
  const LatticeNode node{8 * kPixelSide, 8 * kPixelSide};
  textured.learn(NodeValue(float4{1e30F, 1e30F, 1e30F, 0}, 1), node);
  textured.update();
  CHECK(textured.usual()[1] < 1e4F);
  textured.fade(1e-6F);
  const TextureFactor factor = textured.at(node, 1);
  for (int i = 0; i < 20; ++i) textured.learn(NodeValue(factor * 0.5F, 1), node);
  textured.update();
  CHECK(textured.usual()[1] == Approx(0.5).epsilon(0.02));
}

TEST_CASE("textures: the light on black is the usual one") {
  TextureLight none;
  none.add(float4{}, TextureFactor{0, 0, 0, 1}, 1);
  const float4 usual = {0.5F, 0.25F, 2, 0};
  for (int i = 0; i < 3; ++i) CHECK(none.with(usual)[i] == Approx(usual[i]));
  TextureLight some = none;
  some.add(float4{0.6F, 0.3F, 0.1F, 0}, TextureFactor{0.8F, 0.6F, 0.5F, 1}, 1);
  CHECK(some.with(usual)[0] == Approx(0.75).epsilon(0.02));
  CHECK(some.with(usual)[1] == Approx(0.5).epsilon(0.02));
}

TEST_CASE("textures: no colour becomes negative") {
  const float4 dark = retextured(float4{0.1F, 0.2F, 0.3F, 0}, float4{1, 1, 1, 0}, TextureFactor{1, 1, 1, 1},
                                 TextureFactor{0, 0.9F, 1, 1});
  CHECK(dark[0] == 0);
  CHECK(dark[1] == Approx(0.1));
  CHECK(dark[2] == Approx(0.3));
}

}  // namespace pprt::surface_textures_test
