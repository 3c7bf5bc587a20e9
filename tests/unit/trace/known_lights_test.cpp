// Shadow rays that are not sent, because a light is known at the primitive that the eye ray hits.
#include <array>
#include <catch2/catch.hpp>

#include "unit/trace/test_scenes.h"

namespace pprt::known_lights_test {

using namespace pprt::test;

namespace {

constexpr std::uint32_t kFloor = 1;

// A floor seen from above, two lights over it, and a screen that hides the second.
SceneDescription floor_and_screen() {
  Material material;
  material.diffuse = 0.8;
  SceneDescription scene = scene_with(material, {{0, 0, 1000}, {1000, 0, 1000}});
  add_square(scene, 5, 0);
  add_sphere(scene, {{3, 0, 3}, 1, 0, {}});
  return scene;
}

struct Traced {
  RaySample sample;
  std::uint64_t shadow_rays = 0;
};

Traced traced(const CompiledScene& scene, const View& view, std::span<const KnownLights> known = {}) {
  Tracer tracer(scene, scene.camera(view));
  const RaySample sample = tracer.trace(0.5 * view.width, 0.5 * view.height, known);
  return {sample, tracer.counts().shadow};
}

}  // namespace

TEST_CASE("known lights: a sample tells which lights it has asked and seen") {
  const SceneDescription scene = floor_and_screen();
  const Traced first = traced(compile(scene), *scene.view);
  REQUIRE(first.sample.primitive == kFloor);
  CHECK(first.sample.lights.asked == 3);
  CHECK(first.sample.lights.seen == 1);
  CHECK(first.shadow_rays == 2);
}

TEST_CASE("known lights: what is known is not asked, and shades as if it had been") {
  const SceneDescription scene = floor_and_screen();
  const CompiledScene compiled = compile(scene);
  const Traced first = traced(compiled, *scene.view);
  const std::array known = {KnownLights{2, {3, 3}, 0}, KnownLights{kFloor, first.sample.lights, 0}};
  const Traced again = traced(compiled, *scene.view, known);
  CHECK(again.shadow_rays == 0);
  CHECK(again.sample.rays == 1);
  CHECK(again.sample.color == first.sample.color);
  CHECK((again.sample.lights.asked == 3 && again.sample.lights.seen == 1));

  // One of them is asked; what is known wrongly is believed.
  const std::array first_only = {KnownLights{kFloor, {1, 1}, 0}}, wrong = {KnownLights{kFloor, {3, 3}, 0}};
  CHECK(traced(compiled, *scene.view, first_only).shadow_rays == 1);
  CHECK(traced(compiled, *scene.view, first_only).sample.color == first.sample.color);
  CHECK(traced(compiled, *scene.view, wrong).sample.color != first.sample.color);
}

TEST_CASE("known lights: those of another primitive do not count") {
  const SceneDescription scene = floor_and_screen();
  const CompiledScene compiled = compile(scene);
  const std::array others = {KnownLights{2, {3, 3}, 0}};
  const Traced found = traced(compiled, *scene.view, others);
  CHECK(found.shadow_rays == 2);
  CHECK(found.sample.color == traced(compiled, *scene.view).sample.color);
}

TEST_CASE("known lights: only the first eight lights are told of") {
  Material material;
  material.diffuse = 0.8;
  std::vector<Vec3d> lights;
  for (int i = 0; i < 10; ++i) lights.push_back({10.0 * i, 0, 1000});
  SceneDescription scene = scene_with(material);
  scene.lights.clear();
  for (const Vec3d& at : lights) scene.lights.push_back({at, Rgb(1, 1, 1), {}});
  add_square(scene, 5, 0);
  const CompiledScene compiled = compile(scene);
  const Traced first = traced(compiled, *scene.view);
  CHECK((first.sample.lights.asked == 255 && first.sample.lights.seen == 255));
  CHECK(first.shadow_rays == 10);
  const std::array known = {KnownLights{kFloor, first.sample.lights, 0}};
  const Traced again = traced(compiled, *scene.view, known);
  CHECK(again.shadow_rays == 2);
  CHECK(again.sample.color == first.sample.color);
}

}  // namespace pprt::known_lights_test
