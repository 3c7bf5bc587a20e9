// What textures show in the image, told without a ray.
#include "trace/projected_textures.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>

#include "parser/aff_parser.h"
#include "unit/trace/test_scenes.h"

namespace pprt::projected_textures_test {

using namespace pprt::test;

namespace {

constexpr int kSize = 100;

// A chequered square, its corners' coordinates from 0 to 3, before a plain one. Only ambient light shows
// them.
std::string squares(const std::string& before = "", const std::string& after = "") {
  return "am 1 1 1\na 1 2 9\n" + before +
         "fm .5 .8 1 0 0 0 0 0 0 0 0 1\n"
         "tt t -1 -1 .4 0 0  1 -1 0 3 0  1 1 -.5 3 3\n"
         "tt t -1 -1 .4 0 0  1 1 -.5 3 3  -1 1 0 0 3\n" +
         after + "fm .5 .8 1 0 0 0 0 0 0 0 0 1\np 3 -9 -9 -3  9 -9 -3  0 9 -3\n";
}

// `fineness`: cells along a side of the texture.
CompiledScene compiled(const std::string& text, int fineness = 4) {
  SceneDescription scene = parse_aff(text, "t.aff").scene;
  Texture& texture = scene.textures.at(0);
  constexpr int kTexels = 64;
  texture.width = texture.height = kTexels;
  texture.rgb.clear();
  for (int y = 0; y < kTexels; ++y) {
    for (int x = 0; x < kTexels; ++x) {
      const bool odd = (x * fineness / kTexels + y * fineness / kTexels) % 2 != 0;
      texture.rgb.insert(texture.rgb.end(),
                         {static_cast<std::uint8_t>(odd ? 230 : 20), static_cast<std::uint8_t>(4 * x),
                          static_cast<std::uint8_t>(4 * y)});
    }
  }
  return compile(scene);
}

// Calls visit(x, y, sample, factor) at random image points. `factor`: of the primitive that is seen there,
// over a square of this side.
template <class Visit>
void for_points(const CompiledScene& scene, Tracer& tracer, double side, int per_side, const Visit& visit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in_image(
      0, scene.camera(view_from({0, 0, 4}, {0, 0, 0}, 45, kSize)).width);
  for (int i = 0; i < 500; ++i) {
    const double x = in_image(random), y = in_image(random);
    const RaySample sample = tracer.trace(x, y, {}, side);
    visit(x, y, sample, tracer.texture_over(sample.primitive, x, y, side, per_side));
  }
}

Tracer tracer_of(const CompiledScene& scene) {
  return {scene, scene.camera(view_from({.3, -.2, 4}, {0, 0, 0}, 40, kSize))};
}

float difference(const Color& a, const Color& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

}  // namespace

TEST_CASE("projected textures: they are the factor of what an eye ray finds") {
  const CompiledScene scene = compiled(squares());
  Tracer tracer = tracer_of(scene);
  int shown = 0;
  for_points(scene, tracer, 0.05, 1, [&](double, double, const RaySample& sample, const auto& factor) {
    CAPTURE(sample.primitive);
    REQUIRE(factor.has_value() == (sample.primitive == 1 || sample.primitive == 2));
    if (!factor) return;
    CHECK(difference(sample.color, Color(.5F, .8F, 1) * *factor) < 2e-3F);
    ++shown;
  });
  CHECK(shown > 100);
  const auto with = tracer.primitives_with_pictures();
  CHECK(std::vector<std::uint8_t>(with.begin(), with.end()) == std::vector<std::uint8_t>{0, 1, 1, 0});
}

TEST_CASE("projected textures: those of what moves are where it is") {
  const CompiledScene scene = compiled(
      squares("x a {\n",
              "}\nk a { transl 4  0 0 0 0 0 0 0  1 .1 .1 .2 0 0 0  2 .3 .2 .5 0 0 0  3 .6 .3 .7 0 0 0 }\n"));
  REQUIRE(scene.moves());
  Tracer tracer = tracer_of(scene);
  for (const double time : {1.0, 1.7}) {
    tracer.set_time(time);
    int shown = 0;
    for_points(scene, tracer, 0.05, 1, [&](double, double, const RaySample& sample, const auto& factor) {
      if (!factor) return;
      CHECK(difference(sample.color, Color(.5F, .8F, 1) * *factor) < 2e-3F);
      ++shown;
    });
    CHECK(shown > 50);
  }
}

TEST_CASE("projected textures: another camera shows others") {
  const CompiledScene scene = compiled(squares());
  Tracer tracer = tracer_of(scene);
  const Color before = tracer.texture_over(1, 55, 55, 0.05, 1).value();
  tracer.set_camera(scene.camera(view_from({.9, .3, 3}, {0, 0, 0}, 40, kSize)));
  const Color after = tracer.texture_over(1, 55, 55, 0.05, 1).value();
  CHECK(difference(before, after) > 0.01F);
  CHECK(difference(Tracer(scene, tracer.camera()).texture_over(1, 55, 55, 0.05, 1).value(), after) == 0);
}

TEST_CASE("projected textures: over a pixel they are the mean of the points in it") {
  const CompiledScene scene = compiled(squares(), 64);  // cells of a texel, narrower than a pixel
  Tracer tracer = tracer_of(scene);
  double of_one = 0, of_64 = 0;
  for_points(scene, tracer, 1, 8, [&](double x, double y, const RaySample& sample, const auto& factor) {
    if (!factor) return;
    constexpr int kSide = 16;
    Color mean(0, 0, 0);
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const double at_x = x + (i + 0.5) / kSide - 0.5, at_y = y + (j + 0.5) / kSide - 0.5;
        mean += tracer.texture_over(sample.primitive, at_x, at_y, 1.0 / kSide, 1).value() *
                (1.0F / (kSide * kSide));
      }
    }
    const auto squared = [&](const Color& c) { return static_cast<double>((c - mean).dot(c - mean)); };
    of_64 += squared(*factor);
    of_one += squared(tracer.texture_over(sample.primitive, x, y, 1, 1).value());
  });
  CHECK(of_one > 0);
  CHECK(of_64 < 0.1 * of_one);
}

TEST_CASE("projected textures: behind the eye there is none") {
  const CompiledScene scene = compiled(
      "am 1 1 1\nfm 1 1 1 0 0 0 0 0 0 0 0 1\n"
      "tt t -9 0 9 0 0  9 0 9 1 0  9 0 -9 1 1\ntt t -9 0 9 0 0  9 0 -9 1 1  -9 0 -9 0 1\n");
  Tracer tracer(scene, scene.camera(view_from({0, 1, 0}, {0, 1, -4}, 60, kSize)));
  CHECK(tracer.texture_over(1, 50, 80, 1, 2).has_value());
  CHECK_FALSE(tracer.texture_over(1, 50, 20, 1, 2).has_value());  // above the horizon
  // A square that the horizon crosses shows what is below it.
  Color below(0, 0, 0);
  for (const double x : {49.625, 49.875, 50.125, 50.375}) {
    for (const double y : {50.075, 50.325, 50.575})
      below += tracer.texture_over(1, x, y, 0.25, 1).value() * (1.0F / 12);
  }
  const Color shown = tracer.texture_over(1, 50, 50.2, 1, 4).value();
  CHECK(difference(shown, below) < 0.1F);
  CHECK(std::isfinite(shown.x + shown.y + shown.z));
}

}  // namespace pprt::projected_textures_test
