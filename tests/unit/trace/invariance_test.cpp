#include <catch2/catch.hpp>
#include <cmath>

#include "spd/spd.h"
#include "unit/trace/test_scenes.h"

namespace pprt::invariance_test {

using namespace pprt::test;

namespace {

constexpr int kSize = 64;

std::vector<Color> picture(const SceneDescription& scene) {
  const CompiledScene compiled = compile(scene);
  View view = *scene.view;
  view.width = view.height = kSize;
  Tracer tracer(compiled, compiled.camera(view));
  std::vector<Color> colors;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) colors.push_back(tracer.trace(x + 0.5, y + 0.5).color);
  }
  return colors;
}

// Share of pixels that are not the same to an eye.
double different(const std::vector<Color>& a, const std::vector<Color>& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Color d = a[i] - b[i];
    count += std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) > 0.01f;
  }
  return count / static_cast<double>(a.size());
}

}  // namespace

// Silhouettes may fall on the other side of a ray; mirrors multiply them.
TEST_CASE("a scene far away, tiny or huge gives the picture that it gives at home") {
  struct Case {
    const char* database;
    int size;
    double tolerance;
  };
  for (const Case c :
       {Case{"tree", 5, 0.002}, Case{"gears", 1, 0.005}, Case{"balls", 2, 0.005}, Case{"teapot", 4, 0.005}}) {
    const SceneDescription scene = make_spd(c.database, c.size);
    const std::vector<Color> home = picture(scene);
    for (const double by : {1e3, 1e6, 1e9}) {
      CAPTURE(c.database, by);
      CHECK(different(home, picture(moved(scene, {by, -by, by}, 1))) <= c.tolerance);
    }
    for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
      CAPTURE(c.database, scale);
      CHECK(different(home, picture(moved(scene, {0, 0, 0}, scale))) <= c.tolerance);
    }
  }
}

TEST_CASE("scaling by a power of two changes no bit") {
  const SceneDescription scene = make_spd("balls", 2);
  CHECK(picture(scene) == picture(moved(scene, {0, 0, 0}, 0x1p-20)));
  CHECK(picture(scene) == picture(moved(scene, {0, 0, 0}, 0x1p+40)));
}

TEST_CASE("an eye a million scene sizes away sees what is there") {
  SceneDescription scene = scene_with(Material(), {{0, 0, 1e9}});
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  const CompiledScene compiled = compile(scene);
  View view = view_from({0, 0, 1e6}, {0, 0, 0}, 2 * std::atan(2e-6) * 180 / 3.14159265358979, 101);
  Tracer tracer(compiled, compiled.camera(view));
  int hits = 0;
  for (int y = 0; y < 101; ++y) {
    for (int x = 0; x < 101; ++x) hits += !tracer.trace(x + 0.5, y + 0.5).at_infinity;
  }
  // A disc of radius 25 pixels.
  CHECK(hits == Approx(3.14159 * 25 * 25).epsilon(0.02));
  const RaySample middle = tracer.trace(50.5, 50.5);
  CHECK(middle.color.x == Approx(0.55).epsilon(1e-5));
}

}  // namespace pprt::invariance_test
