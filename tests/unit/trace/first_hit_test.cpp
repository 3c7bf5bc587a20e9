#include <catch2/catch.hpp>
#include <cmath>

#include "unit/trace/test_scenes.h"

namespace pprt::first_hit_test {

using namespace pprt::test;

TEST_CASE("depth is measured along the direction of view, in the scene's units") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 100, 0);
  const CompiledScene compiled = compile(scene);
  const Tracer tracer(compiled, compiled.camera(view_from({0, 0, 10}, {0, 0, 0})));
  // The same in the middle and in a corner: it is no distance from the eye.
  CHECK(tracer.first_hit(32, 32).depth == Approx(10));
  CHECK(tracer.first_hit(0, 0).depth == Approx(10));
}

TEST_CASE("the normal looks at the eye, in the scene's axes, from either side") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(view_from({0, 3, 10}, {0, 0, 0})));
  CHECK(tracer.first_hit(32, 32).normal == Vec3f(0, 0, 1));
  tracer.set_camera(compiled.camera(view_from({0, 3, -10}, {0, 0, 0})));
  CHECK(tracer.first_hit(32, 32).normal == Vec3f(0, 0, -1));
}

TEST_CASE("normals of patches are interpolated unless the effect is ruled out") {
  SceneDescription scene = scene_with(Material());
  const Vec3d tilted = Vec3d(1, 0, 1).normalized();
  const std::array<PatchVertex, 3> corners{
      {{{-3, -3, 0}, tilted}, {{3, -3, 0}, tilted}, {{0, 3, 0}, tilted}}};
  add_patch(scene, corners, 0);
  const View view = view_from({0, 0, 10}, {0, 0, 0});
  const CompiledScene smooth = compile(scene);
  CHECK(Tracer(smooth, smooth.camera(view)).first_hit(32, 32).normal.x == Approx(std::sqrt(0.5)));
  const CompiledScene flat = compile(scene, {.effects = EffectSet()});
  CHECK(Tracer(flat, flat.camera(view)).first_hit(32, 32).normal.x == 0);
}

TEST_CASE("a first hit numbers its primitive and material as in the file") {
  SceneDescription scene = scene_with(Material());
  scene.materials.push_back({.color = {1, 0, 0}});
  add_square(scene, 50, -5);                  // the first: 1
  add_sphere(scene, {{-2, 0, 0}, 1, 1, {}});  // 2
  add_square(scene, 1, 1);                    // 3
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(view_from({-2, 0, 10}, {-2, 0, 0})));
  CHECK(tracer.first_hit(32, 32).primitive == 2);
  CHECK(tracer.first_hit(32, 32).material == 2);
  CHECK(tracer.first_hit(1, 1).primitive == 1);
  CHECK(tracer.primitive_count() == 3);
  CHECK(tracer.first_hit(1, 1).material == 1);
  tracer.set_camera(compiled.camera(view_from({0, 0, 10}, {0, 0, 0})));
  CHECK(tracer.first_hit(32, 32).primitive == 3);
  CHECK(tracer.counts().primary == 0);
}

TEST_CASE("a miss has infinite depth and no primitive") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  const CompiledScene compiled = compile(scene);
  const FirstHit miss =
      Tracer(compiled, compiled.camera(view_from({0, 0, 10}, {0, 0, 20}))).first_hit(32, 32);
  CHECK(std::isinf(miss.depth));
  CHECK(miss.normal == Vec3f(0, 0, 0));
  CHECK(miss.primitive == 0);
  CHECK(miss.material == 0);
}

}  // namespace pprt::first_hit_test
