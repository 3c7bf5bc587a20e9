#include <catch2/catch.hpp>

#include "spd/spd.h"
#include "unit/trace/test_scenes.h"

namespace pprt::visibility_test {

using namespace pprt::test;

TEST_CASE("what an eye has seen it sees again") {
  for (const char* name : {"tree", "balls", "gears", "teapot", "lattice"}) {
    const SceneDescription scene = make_spd(name, 3);
    const CompiledScene compiled = compile(scene);
    View view = *scene.view;
    view.width = view.height = 100;
    Tracer tracer(compiled, compiled.camera(view));
    int hidden = 0;
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 100; ++x) {
        const RaySample sample = tracer.trace(x + 0.25, y + 0.75);
        hidden += !tracer.visible(sample.hit, sample.at_infinity);
      }
    }
    CAPTURE(name);
    CHECK(hidden <= 10);  // one in a thousand: silhouettes, where a surface is seen from its edge
    CHECK(tracer.counts().visibility == 10000);
  }
}

TEST_CASE("a hit point is hidden from an eye behind something, and a direction too") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  add_square(scene, 1, 2);
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(view_from({0, 5, 1}, {0, 0, 0})));
  const RaySample between = tracer.trace(32, 32);
  REQUIRE_FALSE(between.at_infinity);
  CHECK(tracer.visible(between.hit, false));
  CHECK(tracer.visible({0, 0, 1}, true));
  tracer.set_camera(compiled.camera(view_from({0, 0, 5}, {0, 0, 0})));
  CHECK_FALSE(tracer.visible(between.hit, false));
  CHECK_FALSE(tracer.visible({0, 0, -1}, true));
  CHECK(tracer.visible({0, 0, 1}, true));
}

TEST_CASE("hit points project back to where their rays came from") {
  const SceneDescription scene = make_spd("balls", 2);
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(*scene.view));
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.5 * i + 0.3, y = 500 - 0.37 * i;
    const RaySample sample = tracer.trace(x, y);
    const Vec3d to_hit = sample.at_infinity ? Vec3d(sample.hit) : Vec3d(sample.hit) - tracer.camera().eye;
    const auto point = project(tracer.camera(), to_hit);
    REQUIRE(point.has_value());
    REQUIRE(std::abs(point->x - x) < 1e-3);
    REQUIRE(std::abs(point->y - y) < 1e-3);
  }
}

}  // namespace pprt::visibility_test
