// The default that studies measure knows of a scene what a rank that renders knows.
#include <catch2/catch.hpp>

#include <utility>
#include <vector>

#include "study/accuracy/curves.h"
#include "tree_setup.h"

namespace pprt::default_method_test {
namespace {

constexpr int kSize = 128;
constexpr double kDensity = 0.125;  // samples a pixel

// Returns the default's error over that of a grid of as many samples.
double error_over_grid(const Subject& subject) {
  const Reference reference = converged_reference(subject, 6);
  const auto rmse = [&](const Method& method) {
    double squared = 0;
    const std::vector<double> densities = {kDensity};
    method.run({subject, densities, 1e9, 1, [&](Rendering&& rendering) {
                  for (std::size_t i = 0; i < rendering.image.pixels.size(); ++i)
                    squared += (rendering.image.pixels[i] - reference.image.pixels[i]).length2();
                }});
    REQUIRE(squared > 0);
    return std::sqrt(squared);
  };
  return rmse(default_method()) / rmse(uniform_method());
}

// A square of black and white texels before the eye.
SceneDescription chequers() {
  SceneDescription scene;
  scene.view = View{};
  scene.view->from = {0, 0, 2}, scene.view->at = {0, 0, 0}, scene.view->angle_degrees = 45;
  scene.lights = {{{1, 2, 3}, {}, {}, false}};
  Texture texture{"chequers", 32, 32, {}};
  for (int i = 0; i < 32 * 32; ++i) {
    const std::uint8_t v = (i % 32 + i / 32) % 2 == 0 ? 255 : 0;
    texture.rgb.insert(texture.rgb.end(), {v, v, v});
  }
  scene.textures = {texture};
  scene.materials.resize(1);
  scene.materials[0].texture = 0;
  TriangleMesh square;
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.texture_points = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  const TriangleCorners halves[] = {{{0, 1, 2}, {}, {0, 1, 2}}, {{0, 2, 3}, {}, {0, 2, 3}}};
  add_mesh(scene, std::move(square), halves);
  return scene;
}

// Balls before a far background: the light changes over each.
SceneDescription balls() {
  SceneDescription scene = chequers();
  scene.textures.clear(), scene.meshes.clear(), scene.triangles.clear(), scene.order.clear();
  scene.materials[0] = {};
  for (int i = 0; i < 16; ++i) add_sphere(scene, {{i % 4 * 0.4 - 0.6, i / 4 * 0.4 - 0.6, 0}, 0.2, 0, {}});
  return scene;
}

double error_over_grid(const SceneDescription& description) {
  const CompiledScene scene = compile(description);
  View view = *description.view;
  view.width = view.height = kSize;
  return error_over_grid(Subject{scene, scene.camera(view)});
}

}  // namespace

TEST_CASE("default method: it knows textures between its samples") {
  CHECK(error_over_grid(chequers()) < 0.2);
}

TEST_CASE("default method: it knows the light on what is round between its samples") {
  CHECK(error_over_grid(balls()) < 0.3);  // .45 without
}

TEST_CASE("methods: the coarsest picture stands for all densities below its own, where that is asked for") {
  const TreeSetup tree(kSize);
  for (const Method& method : {default_method(), delaunay_method()}) {
    CAPTURE(method.name);
    const auto densities_of = [&](bool takes_coarsest) {
      std::vector<double> found;
      const std::vector<double> densities = {1e-4, 1e-3, 0.05, 0.1};
      method.run({.subject = tree.subject(),
                  .densities = densities,
                  .limit_s = 1e9,
                  .sink = [&](Rendering&& rendering) { found.push_back(rendering.samples); },
                  .takes_coarsest = takes_coarsest});
      return found;
    };
    const std::vector<double> without = densities_of(false), with = densities_of(true);
    REQUIRE(without.size() == 2);
    CHECK(without[0] == Approx(0.05).epsilon(0.01));
    REQUIRE(with.size() == 3);
    CHECK(with[0] > 1e-3);
    CHECK(with[0] < 0.9 * with[1]);
    CHECK(with[1] == without[0]);
  }
}

}  // namespace pprt::default_method_test
