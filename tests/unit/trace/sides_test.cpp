#include <catch2/catch.hpp>

#include "unit/trace/test_scenes.h"

namespace pprt::sides_test {

using namespace pprt::test;

namespace {

Material matte() {
  return {};
}

Material glass() {
  Material material;
  material.transmittance = 0.5;
  material.refractive_index = 1;
  return material;
}

constexpr Vec3d kAbove(0, 0, 10), kBelow(0, 0, -10), kMiddle(0, 0, 0);

// Distance at which the ray through the middle of the image hits; negative for a miss.
double hit_distance(const SceneDescription& scene, const Vec3d& from, const Vec3d& at, bool cull = false) {
  CompileOptions options;
  options.cull = cull;
  const CompiledScene compiled = compile(scene, options);
  View view = view_from(from, at);
  const Camera camera = compiled.camera(view);
  Tracer tracer(compiled, camera);
  const RaySample sample = tracer.trace(32, 32);
  if (sample.at_infinity) return -1;
  // Back to scene units by the ratio of two lengths that are known in both spaces.
  const double scale =
      (compiled.camera(view_from(from, at)).eye - compiled.camera(view_from(at, from)).eye).length() /
      (from - at).length();
  return (Vec3d(sample.hit) - camera.eye).length() / scale;
}

}  // namespace

TEST_CASE("everything is two-sided by default") {
  SceneDescription scene = scene_with(matte());
  add_square(scene, 1, 0);
  CHECK(hit_distance(scene, kAbove, kMiddle) == Approx(10));
  CHECK(hit_distance(scene, kBelow, kMiddle) == Approx(10));
  SceneDescription ball = scene_with(matte());
  add_sphere(ball, {{0, 0, 0}, 2, 0, {}});
  CHECK(hit_distance(ball, kAbove, kMiddle) == Approx(8));
  CHECK(hit_distance(ball, kMiddle, {0.3, 1, 0.2}) == Approx(2));
}

TEST_CASE("culling removes the backs of opaque surfaces") {
  SceneDescription scene = scene_with(matte());
  add_square(scene, 1, 0);
  CHECK(hit_distance(scene, kAbove, kMiddle, true) == Approx(10));
  CHECK(hit_distance(scene, kBelow, kMiddle, true) < 0);
  SceneDescription ball = scene_with(matte());
  add_sphere(ball, {{0, 0, 0}, 2, 0, {}});
  CHECK(hit_distance(ball, kAbove, kMiddle, true) == Approx(8));
  CHECK(hit_distance(ball, kMiddle, {0.3, 1, 0.2}, true) < 0);
  SceneDescription tube = scene_with(matte());
  add_cone(tube, {{0, 0, -3}, 1, {0, 0, 3}, 1, 0, {}});
  CHECK(hit_distance(tube, {5, 0, 0}, {0, 1e-3, 0}, true) == Approx(4).epsilon(1e-5));
  CHECK(hit_distance(tube, kMiddle, {5, 0, 0}, true) < 0);
  CHECK(hit_distance(tube, kMiddle, {5, 0, 0}, false) == Approx(1));
}

TEST_CASE("culling keeps both faces of transmitting surfaces") {
  SceneDescription scene = scene_with(glass());
  add_square(scene, 1, 0);
  CHECK(hit_distance(scene, kBelow, kMiddle, true) == Approx(10));
  SceneDescription ball = scene_with(glass());
  add_sphere(ball, {{0, 0, 0}, 2, 0, {}});
  CHECK(hit_distance(ball, kMiddle, {0.3, 1, 0.2}, true) == Approx(2));
}

TEST_CASE("a culled surface casts no shadow on what its back looks at") {
  SceneDescription scene = scene_with(matte(), {{0, 0, -20}});
  for (const double z : {0.0, 5.0}) {  // two squares, one above the other, both with their fronts down
    const Vec3d corners[] = {{-1, -1, z}, {-1, 1, z}, {1, 1, z}, {1, -1, z}};
    add_polygon(scene, corners, 0);
  }
  // The front of the upper one; the lower one stands between it and the light.
  const auto red = [&](bool cull) {
    CompileOptions options;
    options.cull = cull;
    return look(compile(scene, options), view_from({5, 0, 3}, {0, 0, 5})).color.x;
  };
  CHECK(red(false) == Approx(0.05));
  CHECK(red(true) == Approx(0.55).epsilon(1e-4));
}

TEST_CASE("a negative radius makes only the inside visible") {
  SceneDescription ball = scene_with(matte());
  add_sphere(ball, {{0, 0, 0}, -2, 0, {}});
  CHECK(hit_distance(ball, kAbove, kMiddle) == Approx(12));
  CHECK(hit_distance(ball, kAbove, kMiddle, true) == Approx(12));
  CHECK(hit_distance(ball, kMiddle, {0.3, 1, 0.2}) == Approx(2));
  SceneDescription tube = scene_with(matte());
  add_cone(tube, {{0, 0, -3}, -1, {0, 0, 3}, -1, 0, {}});
  CHECK(hit_distance(tube, {5, 0, 0}, kMiddle) == Approx(6));
  CHECK(hit_distance(tube, kMiddle, {5, 0, 0}) == Approx(1));
}

TEST_CASE("a cone is open at both ends, and a tip closes it") {
  SceneDescription tube = scene_with(matte());
  add_cone(tube, {{0, 0, -3}, 1, {0, 0, 3}, 1, 0, {}});
  CHECK(hit_distance(tube, kAbove, kMiddle) < 0);
  SceneDescription hat = scene_with(matte());
  add_cone(hat, {{0, 0, 0}, 1, {0, 0, 3}, 0, 0, {}});
  CHECK(hit_distance(hat, {0.5, 0, 10}, {0.5, 0, 0}) == Approx(8.5));
  CHECK(hit_distance(hat, {0.5, 0, -10}, {0.5, 0, 0}) == Approx(11.5));
}

TEST_CASE("a ray through the notch of a concave polygon misses it") {
  SceneDescription scene = scene_with(matte());
  add_polygon(scene, std::vector<Vec3d>{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {0, -1, 0}, {-2, 2, 0}}, 0);
  CHECK(hit_distance(scene, {0, 0.5, 10}, {0, 0.5, 0}) < 0);
  CHECK(hit_distance(scene, {0, -1.5, 10}, {0, -1.5, 0}) == Approx(10));
  CHECK(hit_distance(scene, {1.9, 1.5, 10}, {1.9, 1.5, 0}) == Approx(10));
}

}  // namespace pprt::sides_test
