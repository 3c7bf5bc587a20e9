#include <catch2/catch.hpp>

#include "spd/spd.h"
#include "trace/compiled_scene.h"

namespace pprt::counts_test {

namespace {

// One ray through each of 65 x 65 pixel corners, by the rules of the published tables.
RayCounts published_counts(const SceneDescription& scene) {
  CompileOptions options;
  options.cull = true;
  options.count_as_published = true;
  const CompiledScene compiled = compile(scene, options);
  View view = *scene.view;
  view.width = view.height = 64;
  Tracer tracer(compiled, compiled.camera(view));
  for (int y = 0; y <= 64; ++y) {
    for (int x = 0; x <= 64; ++x) tracer.trace(x, y);
  }
  return tracer.counts();
}

}  // namespace

// The expected numbers are those of an independent ray counter; edge rays depend on rounding.
TEST_CASE("ray counts of a small sphereflake and a small tree equal those of an independent counter") {
  const RayCounts balls = published_counts(make_spd("balls", 2));
  CHECK(balls.primary == 4225);
  CHECK(balls.eye_hits == 4225);
  CHECK(balls.reflection == Approx(1692).epsilon(0.003));
  CHECK(balls.shadow == Approx(13880).epsilon(0.003));
  CHECK(balls.refraction + balls.total_internal_reflection == 0);

  const RayCounts tree = published_counts(make_spd("tree", 4));
  CHECK(tree.eye_hits == Approx(2557).epsilon(0.003));
  CHECK(tree.shadow == Approx(17059).epsilon(0.003));
  CHECK(tree.reflection + tree.refraction + tree.total_internal_reflection == 0);
}

TEST_CASE("counting as published, a transmitting surface reflects even with Ks = 0") {
  SceneDescription scene = make_spd("gears", 1);
  for (Material& m : scene.materials) m.specular = 0;
  const RayCounts counts = published_counts(scene);
  CHECK(counts.refraction > 0);
  CHECK(counts.reflection == counts.refraction + counts.total_internal_reflection);
}

}  // namespace pprt::counts_test
