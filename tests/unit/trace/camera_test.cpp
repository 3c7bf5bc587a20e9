#include "base/camera.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "base/diagnostics.h"
#include "trace/compiled_scene.h"
#include "unit/trace/test_scenes.h"

namespace pprt::camera_test {

using namespace pprt::test;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

CompiledScene any_scene() {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  return compile(scene);
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b)) / kDegree;
}

}  // namespace

TEST_CASE("the angle spans the centres of the first and last pixel") {
  const CompiledScene scene = any_scene();
  const Camera camera = scene.camera(view_from({3, 4, 5}, {0, 0, 0}, 45, 512));
  const Vec3d top = ray_direction(camera, 256, 0.5), bottom = ray_direction(camera, 256, 511.5);
  const Vec3d left = ray_direction(camera, 0.5, 256), right = ray_direction(camera, 511.5, 256);
  CHECK(angle_between(top, bottom) == Approx(45).epsilon(1e-12));
  CHECK(angle_between(left, right) == Approx(45).epsilon(1e-12));
  // Pixel corner i of the published counts.
  const double corner = (2.0 * 100 / 512 - 1) * (512.0 / 511) * std::tan(22.5 * kDegree);
  CHECK(ray_direction(camera, 100, 256).dot(camera.right) == Approx(corner).epsilon(1e-12));
}

TEST_CASE("an oblong image has square pixels, and the angle is the vertical one") {
  View view = view_from({0, 0, 5}, {0, 0, 0}, 30);
  view.width = 640;
  view.height = 360;
  const Camera camera = any_scene().camera(view);
  CHECK(angle_between(ray_direction(camera, 320, 0.5), ray_direction(camera, 320, 359.5)) ==
        Approx(30).epsilon(1e-12));
  CHECK(project(camera, ray_direction(camera, 17.25, 300.5)).value().x == Approx(17.25));
  CHECK(project(camera, ray_direction(camera, 17.25, 300.5)).value().y == Approx(300.5));
}

TEST_CASE("the image is not mirrored: x runs along forward x up, y downwards") {
  const Camera camera = any_scene().camera(view_from({0, 0, 5}, {0, 0, 0}));
  CHECK((camera.forward - Vec3d(0, 0, -1)).length() < 1e-15);
  CHECK((camera.right - Vec3d(1, 0, 0)).length() < 1e-15);
  CHECK((camera.up - Vec3d(0, 1, 0)).length() < 1e-15);
  CHECK(ray_direction(camera, 64, 32).x > 0);
  CHECK(ray_direction(camera, 32, 0).y > 0);
}

TEST_CASE("neither the length of up nor the distance to the target changes the camera") {
  const CompiledScene scene = any_scene();
  View view = view_from({1, 2, 3}, {0, 0, 0});
  const Camera plain = scene.camera(view);
  view.at = view.from + (view.at - view.from) * 1e7;
  view.up = {0, 1e-12, 0};
  const Camera same = scene.camera(view);
  CHECK((plain.right - same.right).length() < 1e-12);
  CHECK((plain.up - same.up).length() < 1e-12);
}

TEST_CASE("an image of one pixel looks straight ahead") {
  const Camera camera = any_scene().camera(view_from({0, 0, 5}, {0, 0, 0}, 45, 1));
  CHECK(std::isfinite(camera.slope_per_pixel));
  CHECK(ray_direction(camera, 0.5, 0.5) == camera.forward);
}

TEST_CASE("a degenerate view is refused, with its place") {
  const CompiledScene scene = any_scene();
  const auto refused = [&](auto&& change) {
    View view = view_from({0, 0, 5}, {0, 0, 0});
    view.location = {7, 3};
    change(view);
    CHECK_THROWS_AS(scene.camera(view), InputError);
    CHECK_THROWS_WITH(scene.camera(view), Catch::StartsWith("test:7:3: error: view: "));
  };
  refused([](View& v) { v.at = v.from; });
  refused([](View& v) { v.up = {0, 0, 0}; });
  refused([](View& v) { v.up = {0, 0, -3}; });
  refused([](View& v) { v.angle_degrees = 0; });
  refused([](View& v) { v.angle_degrees = 180; });
  refused([](View& v) { v.angle_degrees = std::nan(""); });
  refused([](View& v) { v.from.x = std::numeric_limits<double>::infinity(); });
  refused([](View& v) { v.height = 0; });
}

TEST_CASE("an eye sees a scene from 2^40 sizes away, and is refused from farther") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 0.5, 0);
  const CompiledScene compiled = compile(scene);
  View view = view_from({0.3e12, 0.4e12, 0.9e12}, {0, 0, 0}, 1e-10);
  CHECK(compiled.distance(view.from) < kFarthestEye);
  Tracer tracer(compiled, compiled.camera(view));
  CHECK_FALSE(tracer.trace(32, 32).at_infinity);
  for (const double distance : {1.2e12, 4e19, 1e200, 1e308}) {
    view.from = {0, 0, distance};
    CHECK_THROWS_AS(compiled.camera(view), InputError);
  }
}

}  // namespace pprt::camera_test
