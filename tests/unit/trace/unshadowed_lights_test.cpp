// What lights bring to primitives, told without a ray.
#include "trace/unshadowed_lights.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "parser/aff_parser.h"
#include "spd/spd.h"
#include "unit/trace/test_scenes.h"

namespace pprt::unshadowed_lights_test {

using namespace pprt::test;

namespace {

float difference(const float4& a, const Color& b) {
  return std::max({std::abs(a[0] - b.x), std::abs(a[1] - b.y), std::abs(a[2] - b.z)});
}

struct Found {
  int lit = 0, hidden = 0;  // samples whose colour is all known but for the lights; of them, those in shadow
  float error = 0;          // the largest
  float unshadowed = 0;     // the same if all lights counted as seen
};

// Compares samples at random image points with what is known there.
Found compare(Tracer& tracer, int size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in_image(0, size);
  Found found;
  for (int i = 0; i < 800; ++i) {
    const double x = in_image(random), y = in_image(random);
    const RaySample sample = tracer.trace(x, y);
    const LitSurface surface = tracer.lit_surfaces()[sample.primitive];
    if (surface.shape == LitShape::kNone || !surface.is_all) continue;
    UnshadowedLight light;
    tracer.unshadowed_light(sample.primitive, x, y, light);
    REQUIRE(light.is_known);
    ++found.lit, found.hidden += sample.lights.seen != sample.lights.asked;
    found.error =
        std::max(found.error, difference(light.unlit + light.of(seen_from(sample.lights)), sample.color));
    found.unshadowed = std::max(found.unshadowed, difference(light.unlit + light.of(0xFF), sample.color));
  }
  return found;
}

Found compare(const SceneDescription& description, const View& view, const CompileOptions& options = {}) {
  const CompiledScene scene = compile(description, options);
  Tracer tracer(scene, scene.camera(view));
  return compare(tracer, view.width);
}

// Nothing is seen through a surface or in it.
EffectSet nothing_in_mirrors() {
  return parse_effects("shadows,highlights,smooth-normals,textures,emission,sky");
}

// A track whose keys lie a second apart. Its curve runs from the second to the last but one.
std::string keys(const std::string& kind, const std::vector<std::string>& values) {
  std::string text = kind + " " + std::to_string(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    text += " " + std::to_string(i) + " " + values[i] + " 0 0 0";
  return text + "\n";
}

constexpr float kRounding = 2e-4F;  // of colours up to a few ones

}  // namespace

TEST_CASE("unshadowed lights: with those that a sample sees they are its colour") {
  for (const char* name :
       {"tree", "tetra", "mount", "teapot", "balls", "rings", "gears", "jacks", "lattice"}) {
    CAPTURE(name);
    const SceneDescription scene = make_spd(name, std::string(name) == "tree" ? 6 : 3);
    CompileOptions options;
    options.effects = nothing_in_mirrors();
    View view = *scene.view;
    view.width = view.height = 120;
    const Found found = compare(scene, view, options);
    CHECK(found.lit > 100);
    CHECK(found.error < kRounding);
    CHECK((found.hidden == 0 || found.unshadowed > 0.01F));
  }
}

TEST_CASE("unshadowed lights: what is far away for its size is lit as it is near") {
  for (const char* shape : {"s 0 0 0 1", "c 0 -3 0 1 0 3 0 1"}) {
    for (const char* distance : {"1e7", "1e9", "1e11"}) {
      CAPTURE(shape, distance);
      const std::string text =
          "v from 0 0 " + std::string(distance) +
          " at 0 0 0 up 0 1 0 angle 1 hither 1 resolution 9 9\nam 0 0 0 l 0 0 1e30 1 1 1\n"
          "fm 0 0 0 .5 .5 .5 0 0 0 0 0 1\n" +
          shape + "\n";
      const SceneDescription scene = parse_aff(text, "far.aff").scene;
      const CompiledScene compiled = compile(scene);
      Tracer tracer(compiled, compiled.camera(*scene.view));
      UnshadowedLight light;
      tracer.unshadowed_light(1, 4.5, 4.5, light);
      REQUIRE(light.is_known);
      CHECK(light.of(0xFF)[0] == Approx(0.5).epsilon(1e-3));
    }
  }
}

TEST_CASE("unshadowed lights: of what mirrors the rest is not known") {
  Material mirror;
  mirror.diffuse = 0.5, mirror.specular = 0.4, mirror.shine = 20;
  SceneDescription scene = scene_with(mirror, {{3, 0, 100}});
  add_square(scene, 5, 0);
  const CompiledScene with = compile(scene);
  CompileOptions options;
  options.effects = nothing_in_mirrors();
  const CompiledScene without = compile(scene, options);
  CHECK_FALSE(Tracer(with, with.camera(*scene.view)).lit_surfaces()[1].is_all);
  CHECK(Tracer(without, without.camera(*scene.view)).lit_surfaces()[1].is_all);
}

TEST_CASE("unshadowed lights: of faces in one plane nothing is known") {
  Material matte;
  matte.diffuse = 0.5;
  for (const double height : {0.0, 0.5}) {
    SceneDescription scene = scene_with(matte, {{3, 0, 100}});
    scene.materials.push_back(matte);
    add_square(scene, 5, 0);
    add_square(scene, 2, height, 1);
    const CompiledScene compiled = compile(scene);
    const Tracer tracer(compiled, compiled.camera(*scene.view));
    for (const std::uint32_t primitive : {1U, 2U})
      CHECK(tracer.lit_surfaces()[tracer.surfaces()[primitive]].is_all == (height > 0));
  }
}

TEST_CASE("unshadowed lights: the first eight lights are told apart") {
  Material material;
  material.diffuse = 0.8;
  for (const int lights : {8, 9}) {
    SceneDescription scene = scene_with(material, {});
    for (int i = 0; i < lights; ++i) scene.lights.push_back({{i - 4.0, 2, 60}, Rgb{1, 0.5, 0.1 * i}, {}});
    add_square(scene, 5, 0);
    const CompiledScene compiled = compile(scene);
    Tracer tracer(compiled, compiled.camera(*scene.view));
    CHECK(tracer.lit_surfaces()[1].is_all == (lights == 8));
    UnshadowedLight light;
    tracer.unshadowed_light(1, 30, 33, light);
    REQUIRE(light.count == 8);
    for (std::size_t i = 0; i < 8; ++i) {
      CHECK(light.of(static_cast<std::uint8_t>(1U << i))[0] == light.each[i][0]);
      CHECK(light.each[i][2] == Approx(light.each[i][0] * 0.1F * static_cast<float>(i)).margin(1e-6));
    }
    float4 sum{};
    for (const float4& each : light.each) sum += each;
    CHECK(light.of(0xFF)[0] == Approx(sum[0]));
    CHECK(light.of(0)[0] == 0);
  }
}

// A ball, a cone and a patch that turn, rise and grow, under lamps of which one goes with them.
TEST_CASE("unshadowed lights: they move with bodies and lights") {
  const std::string text =
      "v from 0 3 12 at 0 1 0 up 0 1 0 angle 30 hither 1 resolution 90 90\n"
      "am 1 1 1 l -6 7 9 .3 .3 .4\nfm .1 .1 .1 .5 .6 .5 0 0 0 0 0 1\np 4 -9 -.5 -9 -9 -.5 9 9 -.5 9 9 -.5 "
      "-9\n"
      "fm .1 0 0 .8 .2 .1 .2 .2 .3 20 0 1\na 1 3 9 x body { s 0 1 0 1 c 1.6 -.5 0 1 1.5 2 0 .4\n"
      "pp 3 -2 0 0 -.3 0 1 -1 0 0 .3 0 1 -1 2 0 0 .2 1 l 5 9 8 .8 .7 .6 }\n"
      "k body {" +
      keys("transl", {"-.5 0 0", "0 0 0", "1 .5 -1", "1 0 -2"}) +
      keys("rot", {"0 1 0 0", "0 1 0 0", "0 1 0 60", "0 1 0 80"}) +
      keys("scale", {"1 1 1", "1 1 1", "1.3 .8 1.2", "1 1 1"}) + "}";
  const SceneDescription scene = parse_aff(text, "m.aff").scene;
  CompileOptions options;
  options.effects = nothing_in_mirrors();
  const CompiledScene compiled = compile(scene, options);
  REQUIRE(compiled.moves());
  Tracer tracer(compiled, compiled.camera(*scene.view));
  for (const double time : {1.0, 1.4, 2.0}) {
    CAPTURE(time);
    tracer.set_time(time);
    const Found found = compare(tracer, 90);
    CHECK(found.lit > 100);
    CHECK(found.hidden > 10);
    CHECK(found.error < kRounding);
  }
}

TEST_CASE("unshadowed lights: beside a primitive its rim counts") {
  Material material;
  material.diffuse = 0.8;
  SceneDescription scene = scene_with(material, {{0, 60, 60}});
  add_sphere(scene, {{0, 0, 0}, 2, 0, {}});
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(*scene.view));
  const int middle = scene.view->width / 2;
  int y = 0;  // the first row in which the sphere is seen
  while (tracer.trace(middle, y).primitive == 0) ++y;
  REQUIRE(y > 3);
  UnshadowedLight rim, beside;
  tracer.unshadowed_light(1, middle, y, rim);
  tracer.unshadowed_light(1, middle, y - 2, beside);
  REQUIRE(rim.of(1)[0] > 0.2F);
  CHECK(beside.of(1)[0] == Approx(rim.of(1)[0]).epsilon(0.3));
  UnshadowedLight none;
  tracer.unshadowed_light(2, middle, middle, none);  // there is no such primitive
  CHECK_FALSE(none.is_known);
}

}  // namespace pprt::unshadowed_lights_test
