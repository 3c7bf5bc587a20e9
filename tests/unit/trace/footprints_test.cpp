// Textures are filtered over what a sample covers: the pyramid, its filter, and the cones of rays to it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>

#include "parser/aff_parser.h"
#include "trace/textures/texture_image.h"
#include "unit/trace/test_scenes.h"

namespace pprt::footprints_test {

using namespace pprt::test;

namespace {

constexpr double kPi = std::numbers::pi;

Texture random_texture(int width, int height) {
  Texture texture{"t", width, height, {}};
  std::mt19937 random(static_cast<unsigned>(100 * width + height));
  for (int i = 0; i < 3 * width * height; ++i)
    texture.rgb.push_back(static_cast<std::uint8_t>(random() % 256));
  return texture;
}

// Waves around 1/2: red along u, green along v, blue along u + v.
Texture waves(int size, int cycles) {
  Texture texture{"t", size, size, {}};
  const auto level = [&](int i) {
    return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * std::cos(2 * kPi * cycles * i / size)));
  };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) texture.rgb.insert(texture.rgb.end(), {level(x), level(y), level(x + y)});
  }
  return texture;
}

// The amplitude of a wave, 1 for waves(), from values at even steps of one period.
template <class Value>
double amplitude(const Value& value) {
  constexpr int kSteps = 64;
  std::complex<double> sum = 0;
  for (int i = 0; i < kSteps; ++i)
    sum += static_cast<double>(value(double{1} / kSteps * i)) * std::polar(1.0, 2 * kPi * i / kSteps);
  return std::abs(sum) * 4 / kSteps;
}

double mean_square(const Color& c) {
  return (c.x * c.x + c.y * c.y + c.z * c.z) / 3;
}

// An ellipse in texels of a square texture; `angle` is that of its first diameter to the u axis.
TextureFootprint ellipse(double first, double second, double angle, int size) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double a = first * first / size / size, b = second * second / size / size;
  return {a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c};
}

// What an even density of this many periods leaves of a wave.
double left_of_wave(double periods) {
  return std::sin(kPi * periods) / (kPi * periods);
}

// What is seen of waves with `cycles` in each unit, by ambient light alone.
CompiledScene wave_scene(const std::string& text) {
  SceneDescription scene = parse_aff("am 1 1 1 b .5 .5 .5\n" + text, "t.aff").scene;
  scene.textures.at(0) = waves(128, 1);
  return compile(scene);
}

// A square of waves at height z, of which one is as long as a unit.
std::string wave_plane(const std::string& z) {
  const auto corner = [&](const char* x, const char* y) {
    return std::string(x) + " " + y + " " + z + " " + x + " " + y + " ";
  };
  return "fm 1 1 1 0 0 0 0 0 0 0 0 1\ntt t " + corner("-90", "-90") + corner("90", "-90") +
         corner("90", "90") + "\ntt t " + corner("-90", "-90") + corner("90", "90") + corner("-90", "90") +
         "\n";
}

// A view from (0, y, z) to the origin whose pixels are `pixel` wide at the distance 1.
View fine_view(double y, double z, double pixel) {
  constexpr int kSize = 101;
  View view = view_from({0, y, z}, {0, 0, 0}, 2 * 180 / kPi * std::atan(pixel * (kSize - 1) / 2), kSize);
  if (y == 0) view.up = {0, 1, 0};
  return view;
}

// The amplitude of a channel along a row or a column through the middle, over a period in pixels.
double seen_along(const CompiledScene& scene, const View& view, const Vec2d& period, int channel) {
  Tracer tracer(scene, scene.camera(view));
  const double middle = 0.5 * view.width;
  return amplitude([&](double share) {
    return tracer.trace(middle + (share - 0.5) * period.x, middle + (share - 0.5) * period.y).color[channel];
  });
}

// RMSE of one sample a pixel with this footprint against 16 x 16 narrow ones.
double error_of(const std::string& text, double footprint) {
  SceneDescription scene = parse_aff(text, "t.aff").scene;
  Texture& checks = scene.textures.at(0);
  checks = {"t", 32, 32, {}};
  for (int i = 0; i < 32 * 32; ++i)
    checks.rgb.insert(checks.rgb.end(), 3, (i / 8 + i / 256) % 2 == 0 ? 30 : 230);
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(*scene.view));
  constexpr int kFine = 16;
  double sum = 0;
  const int width = scene.view->width, height = scene.view->height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Color mean(0, 0, 0);
      for (int i = 0; i < kFine * kFine; ++i) {
        const double column = (i % kFine + 0.5) / kFine, row = (i / kFine + 0.5) / kFine;
        mean += tracer.trace(x + column, y + row, {}, 1.0 / kFine).color * (1.F / kFine / kFine);
      }
      sum += mean_square(tracer.trace(x + 0.5, y + 0.5, {}, footprint).color - mean);
    }
  }
  return std::sqrt(sum / (width * height));
}

}  // namespace

TEST_CASE("footprints: each level of the pyramid has the texture's mean, whatever its size") {
  for (const auto& [width, height] :
       {std::pair(1, 1), {1, 7}, {6, 1}, {2, 2}, {5, 3}, {8, 8}, {13, 6}, {31, 33}, {64, 2}}) {
    CAPTURE(width, height);
    const Texture texture = random_texture(width, height);
    const TextureImage image(texture);
    Color mean(0, 0, 0);
    for (std::size_t i = 0; i < texture.rgb.size(); ++i)
      mean[static_cast<int>(i % 3)] += static_cast<float>(texture.rgb[i]) / (255.F * width * height);
    for (int level = 1; level < 8; ++level) {
      CAPTURE(level);
      // A footprint that is one bilinear value of the level; its means over the level's texels.
      const double side = std::sqrt(3.0) * (1 << level) * (1 + 1e-12);
      const TextureFootprint footprint = {side * side / width / width, 0, side * side / height / height};
      const int columns = std::max(1, width >> level), rows = std::max(1, height >> level);
      Color sum(0, 0, 0);
      for (int i = 0; i < columns * rows; ++i)
        sum += image.over(footprint, {(i % columns + 0.5) / columns, (i / columns + 0.5) / rows});
      const Color off = sum * (1.F / static_cast<float>(columns * rows)) - mean;
      CHECK(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) < 0.51 / 255);
    }
  }
}

TEST_CASE(
    "footprints: a magnified texture is bilinear to the bit, pictures repeat, and no footprint is too "
    "large") {
  const TextureImage image(random_texture(24, 10));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-2, 2);
  const double most = std::sqrt(3.0) * (1 - 1e-12);
  for (int i = 0; i < 1000; ++i) {
    const Vec2d point(anywhere(random), anywhere(random));
    const TextureFootprint texel = {most * most / 24 / 24, 0, most * most / 10 / 10};
    REQUIRE(image.over(texel, point) == image.at(point));
  }
  // Of numbers with few digits no rounding is left.
  const TextureFootprint slanted = {.04, .02, .05};
  for (const double x : {-0.5, 0.25, 0.625}) {
    for (const double y : {0.125, 0.75}) {
      const Color off = image.over(slanted, {x, y}) - image.over(slanted, {x + 3, y - 5});
      CHECK(mean_square(off) < 1e-12);
    }
  }
  for (const double huge : {1e10, 1e200}) {
    const Color mean = image.over({huge, 0, huge}, {0.3, 0.3});
    CHECK(mean == image.over({1e10, 0, 1e10}, {0.7, 0.1}));
  }
  for (const double odd : {std::nan(""), HUGE_VAL, -1.0})
    CHECK(image.over({odd, odd, odd}, {0.3, 0.3}).x >= 0);
}

// An even density over a diameter has the variance diameter^2 / 12. Waves are long, so that nothing but the
// variance counts: a filter of this variance leaves exp(-2 pi^2 variance / period^2).
TEST_CASE("footprints: the filter is as wide as the footprint, along both axes of an ellipse") {
  constexpr int kSize = 512, kCycles = 2;
  const TextureImage image(waves(kSize, kCycles));
  const auto left = [&](const TextureFootprint& footprint, const Vec2d& along, int channel) {
    return amplitude([&](double share) { return image.over(footprint, along * (share / kCycles))[channel]; });
  };
  const auto expected = [&](double across_u, double across_v, const TextureFootprint& f) {
    const double periods2 =
        kCycles * kCycles *
        (f.uu * across_u * across_u + 2 * f.uv * across_u * across_v + f.vv * across_v * across_v);
    return std::exp(-kPi * kPi / 6 * periods2);
  };
  const Vec2d u(1, 0), v(0, 1);
  const auto check = [&](const TextureFootprint& footprint) {
    CHECK(left(footprint, u, 0) == Approx(expected(1, 0, footprint)).margin(0.005));
    CHECK(left(footprint, v, 1) == Approx(expected(0, 1, footprint)).margin(0.005));
  };
  for (const double diameter : {4.0, 11.0, 16.0, 23.0, 32.0, 45.0, 64.0}) {
    CAPTURE(diameter);
    check(ellipse(diameter, diameter, 0, kSize));
  }
  for (const double longer : {24.0, 40.0, 64.0}) {
    for (const double degrees : {0.0, 20.0, 45.0, 90.0, 135.0, 160.0}) {
      CAPTURE(longer, degrees);
      const TextureFootprint slanted = ellipse(longer, 16, degrees * kPi / 180, kSize);
      check(slanted);
      CHECK(left(slanted, u, 2) == Approx(expected(1, 1, slanted)).margin(0.01));
    }
  }
  // The bound: a footprint is filtered as if it had at least 1 / 4.7 of its length as breadth.
  constexpr double kLeast = 0.2132;
  for (const double shorter : {0.0, 2.0, 10.0}) {
    CAPTURE(shorter);
    CHECK(left(ellipse(60, shorter, 0, kSize), u, 0) ==
          Approx(expected(1, 0, ellipse(60, shorter, 0, kSize))).margin(0.005));
    CHECK(left(ellipse(250, shorter, 0, kSize), v, 1) ==
          Approx(expected(0, 1, ellipse(250, 250 * kLeast, 0, kSize))).margin(0.005));
  }
}

// What a pixel shows of a wave that is p pixels long is left_of_wave(1 / p), wherever its footprint is right.
TEST_CASE("footprints: a pixel's footprint grows with the distance, and is longer where the ray is flat") {
  const CompiledScene scene = wave_scene(wave_plane("0"));
  for (const double distance : {5.0, 20.0}) {
    for (const double pixels : {4.0, 8.0}) {
      CAPTURE(distance, pixels);
      const View view = fine_view(0, distance, 1 / pixels / distance);
      CHECK(seen_along(scene, view, {pixels, 0}, 0) == Approx(left_of_wave(1 / pixels)).margin(0.01));
      CHECK(seen_along(scene, view, {0, pixels}, 1) == Approx(left_of_wave(1 / pixels)).margin(0.01));
    }
  }
  for (const double degrees : {30.0, 60.0, 70.0}) {
    CAPTURE(degrees);
    const double angle = degrees * kPi / 180, pixels = 12;
    const View view = fine_view(80 * std::sin(angle), 80 * std::cos(angle), 1 / pixels / 80);
    CHECK(seen_along(scene, view, {pixels, 0}, 0) == Approx(left_of_wave(1 / pixels)).margin(0.01));
    const double upright = pixels * std::cos(angle);
    CHECK(seen_along(scene, view, {0, upright}, 1) == Approx(left_of_wave(1 / upright)).margin(0.02));
  }
}

TEST_CASE("footprints: mirrors and lenses widen and narrow them as they do the ray") {
  const std::string mirror = "fm 0 0 0 0 0 0 1 1 1 0 0 1\n", glass = "fm 0 0 0 0 0 0 0 0 0 0 1 1.5\n";
  // Widths over those at the first surface, by matrix optics near the axis. The eye is 10 from the surface.
  const double spread = 0.1;
  struct Case {
    std::string objects;
    double growth;
  };
  const double bulge = 1 / 50.0;
  const auto smooth = [&](double sign) {
    std::string patch = "pp 4 ";
    for (const auto& [x, y] : {std::pair(-2, -2), {2, -2}, {2, 2}, {-2, 2}})
      patch += std::to_string(x) + " " + std::to_string(y) + " 0 " + std::to_string(sign * x * bulge) + " " +
               std::to_string(sign * y * bulge) + " 1 ";
    return patch + "\n";
  };
  // A ball of radius r as a lens: refracted at both faces by the power -1 / (2 r) within, -1 / (2 r) beyond.
  const auto through_ball = [&](double r, double beyond) {
    double width = 1, slope = spread;
    slope = slope / 1.5 - width / (3 * r);
    width += slope * 2 * r;
    slope = 1.5 * slope - width / (2 * r);
    return std::abs(width + slope * beyond);
  };
  const std::vector<Case> cases = {
      {mirror + "p 4 -2 -2 0 2 -2 0 2 2 0 -2 2 0\n" + wave_plane("20"), 1 + spread * 20},
      {mirror + "s 0 0 -50 50\n" + wave_plane("20"), 1 + (spread + 2 * bulge) * 20},
      {mirror + "s 0 0 80 -80\n" + wave_plane("20"), 1 + (spread - 2.0 / 80) * 20},
      {mirror + smooth(1) + wave_plane("20"), 1 + (spread + 2 * bulge) * 20},
      {mirror + smooth(-1) + wave_plane("20"), 1 + (spread - 2 * bulge) * 20},
      {glass + "s 0 0 -8 8\n" + wave_plane("-26"), through_ball(8, 10)},
      {glass + "s 0 0 -8 8\n" + wave_plane("-76"), through_ball(8, 60)},  // beyond the focus
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CAPTURE(i);
    const double pixels = 4, at_surface = 1 / pixels / cases[i].growth;
    const View view = fine_view(0, 10, at_surface / 10);
    const CompiledScene scene = wave_scene(cases[i].objects);
    CHECK(seen_along(scene, view, {pixels, 0}, 0) == Approx(left_of_wave(1 / pixels)).margin(0.02));
    CHECK(seen_along(scene, view, {0, pixels}, 1) == Approx(left_of_wave(1 / pixels)).margin(0.02));
  }
}

TEST_CASE("footprints: checks to the horizon and in a mirror have no moire") {
  const std::string floor =
      "am 1 1 1 b .5 .6 .8 v from 0 1.2 6 at 0 1 0 up 0 1 0 angle 40 hither .1 resolution 48 36\n"
      "fm 1 1 1 0 0 0 0 0 0 0 0 1\n"
      "tt t -400 0 20 -400 20  400 0 20 400 20  400 0 -800 400 -800\n"
      "tt t -400 0 20 -400 20  400 0 -800 400 -800  -400 0 -800 -400 -800\n";
  const std::string ball = "fm .02 .02 .02 0 0 0 .9 .9 .9 0 0 1\ns 0 1.1 0 1.1\n";
  for (const std::string& scene : {floor, floor + ball}) {
    const double filtered = error_of(scene, 1), points = error_of(scene, 1e-9);
    CAPTURE(filtered, points);
    CHECK(points > 0.1);  // the control: the checks alias
    CHECK(filtered < 0.35 * points);
  }
}

}  // namespace pprt::footprints_test
