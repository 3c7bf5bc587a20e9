// Where a scene lies and how large it is does not show in its picture.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "pictures.h"
#include "spd/spd.h"
#include "test_scenes.h"

using namespace pprt;
using namespace pprt::test;

namespace {

constexpr int kSize = 128;

// Rays that pass an edge on the other side. Measured: at most 2 pixels of 16384 (balls).
constexpr double kShareOfEdges = 0.001;

SceneDescription any_scene() {
  const std::string name = GENERATE("tree:4", "balls:2", "gears:1", "rings:1", "mount:3", "lattice:1",
                                    "jacks:2", "tetra:3", "teapot:2");
  return make_spd_scene("spd:" + name);
}

}  // namespace

TEST_CASE("a tiny or huge scene gives the picture that it gives at home") {
  const SceneDescription scene = any_scene();
  const std::vector<Rgb> home = traced_picture(scene, kSize);
  for (const double scale : {1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9}) {
    CAPTURE(scene.name, scale);
    CHECK(share_different(home, traced_picture(moved(scene, {0, 0, 0}, scale), kSize)) <= kShareOfEdges);
  }
}

// A coordinate at 1e9 is rounded by up to 2^-24 before the renderer sees it. The renderer itself rounds by up
// to 2^-25 of the scene's size, raised to a power of two: 2^-24 again for the smallest of these, of size 1.5.
TEST_CASE("a scene up to 1e9 away gives the picture that it gives at home") {
  const SceneDescription scene = any_scene();
  const std::vector<Rgb> home = traced_picture(scene, kSize);
  for (const double by : {1e3, 1e6, 1e9}) {
    CAPTURE(scene.name, by);
    CHECK(share_different(home, traced_picture(moved(scene, {by, -by, by}, 1), kSize)) <= kShareOfEdges);
  }
}

// Beyond that no renderer can tell what the file has lost. Brought home, which is exact, the scene has lost
// the same, and gives the same picture at both places (measured: no pixel differs), while that of home is
// another by up to 0.8 % of its pixels.
TEST_CASE("a scene farther away loses only what its coordinates have lost") {
  const SceneDescription scene = any_scene();
  for (const double by : {1e9, 1e11, 1e12}) {
    const SceneDescription far = moved(scene, {by, -by, by}, 1);
    const SceneDescription brought_home = moved(far, {-by, by, -by}, 1);
    CAPTURE(scene.name, by);
    CHECK(share_different(traced_picture(brought_home, kSize), traced_picture(far, kSize)) <= kShareOfEdges);
  }
}
