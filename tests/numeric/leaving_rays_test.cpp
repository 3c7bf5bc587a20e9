// Rays that leave a surface must not find it again. Every scene here is such that no point can shade another;
// so whatever the lights, a picture with shadows equals one without, ray by ray.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "test_scenes.h"

using namespace pprt;
using namespace pprt::test;

namespace {

constexpr int kLights = 25;
constexpr int kSize = 100;

// Lights all around; many of them graze whatever surface there is.
void add_lights(SceneDescription& scene, double distance) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < kLights; ++i) {
    const Vec3d direction = Vec3d(normal(engine), normal(engine), normal(engine)).normalized();
    scene.lights.push_back({direction * distance, {}, {}});
  }
}

// Shadow rays traced; requires that none was stopped.
std::uint64_t check_no_shadow(SceneDescription scene, const View& view, double light_distance = 50) {
  scene.lights.clear();
  add_lights(scene, light_distance);
  CompileOptions without;
  without.effects = parse_effects("smooth-normals");
  const CompiledScene shadowed = compile(scene), plain = compile(scene, without);
  View large = view;
  large.width = large.height = kSize;
  Tracer a(shadowed, shadowed.camera(large)), b(plain, plain.camera(large));
  int differing = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const RaySample with = a.trace(x + 0.5, y + 0.5), sans = b.trace(x + 0.5, y + 0.5);
      differing += with.color != sans.color;
    }
  }
  CHECK(differing == 0);
  return a.counts().shadow;
}

// Pictures of the scene from around it until enough rays have left it.
void check_around(const SceneDescription& scene, double distance) {
  std::uint64_t rays = 0;
  for (int i = 0; rays < 100000; ++i) {
    REQUIRE(i < 40);
    const Vec3d from(std::cos(i), std::sin(i), std::sin(2.3 * i));
    rays += check_no_shadow(scene, view_from(from.normalized() * distance, {0, 0, 0}, 25));
  }
}

SceneDescription matte() {
  return scene_with(Material());
}

}  // namespace

TEST_CASE("rays leave a sphere, whatever its size in the scene") {
  for (const double radius : {1.0, 0.01, 1e-4}) {
    SceneDescription scene = matte();
    add_sphere(scene, {{0, 0, 0}, radius, 0, {}});
    if (radius < 1) {  // something far off makes the scene large; it lies outside every ray's way
      add_sphere(scene, {{1000 * radius, 1000 * radius, 1000 * radius}, 1e-3 * radius, 0, {}});
    }
    CAPTURE(radius);
    check_around(scene, 5 * radius);
  }
}

TEST_CASE("rays leave the inside of a sphere") {
  SceneDescription scene = matte();
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  std::uint64_t rays = 0;
  for (int i = 0; i < 3; ++i)
    rays += check_no_shadow(scene, view_from({0.1, 0.2, 0.3 * i}, {1, 1.0 * i, 0}, 90), 0.9);
  CHECK(rays > 100000);
}

TEST_CASE("rays leave cylinders and cones") {
  SceneDescription cylinder = matte();
  add_cone(cylinder, {{0, 0, -50}, 1, {0, 0, 50}, 1, 0, {}});
  SceneDescription cone = matte();
  add_cone(cone, {{0, 0, -2}, 1, {0, 0, 2}, 0, 0, {}});
  // Seen from its sides only: through the open ends the inside would be seen, which does lie in shadow.
  for (const SceneDescription& scene : {cylinder, cone}) {
    std::uint64_t rays = 0;
    for (int i = 0; i < 12; ++i) {
      rays += check_no_shadow(scene, view_from({6 * std::cos(i), 6 * std::sin(i), 0.5}, {0, 0, 0}, 18), 40);
    }
    CHECK(rays > 100000);
  }
}

TEST_CASE("rays leave polygons, slender and concave ones too") {
  SceneDescription square = matte();
  add_square(square, 1, 0);
  check_around(square, 4);

  SceneDescription star = matte();
  std::vector<Vec3d> corners;
  for (int i = 0; i < 144; ++i) {
    const double radius = i % 4 < 2 ? 1 : 0.9;
    corners.emplace_back(radius * std::cos(i * std::numbers::pi / 72),
                         radius * std::sin(i * std::numbers::pi / 72), 0);
  }
  add_polygon(star, corners, 0);
  check_around(star, 4);

  SceneDescription strip = matte();
  add_polygon(strip, std::vector<Vec3d>{{-1, -0.01, 0}, {1, -0.01, 0.3}, {1, 0.01, 0.3}, {-1, 0.01, 0}}, 0);
  std::uint64_t rays = 0;
  for (int i = 0; i < 30; ++i) rays += check_no_shadow(strip, view_from({0, 0.1 * i, 1}, {0, 0, 0.15}, 10));
  CHECK(rays > 20000);
}

TEST_CASE("rays leave triangles of any shape in any plane") {
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto point = [&] { return Vec3d(u(engine), u(engine), u(engine)); };
  std::uint64_t rays = 0;
  for (int i = 0; i < 20; ++i) {
    const Vec3d a = point(), b = point(), c = a + (b - a) * 0.4 + point() * (i % 2 ? 1 : 0.05);
    SceneDescription scene = matte();
    add_polygon(scene, std::vector<Vec3d>{a, b, c}, 0);
    const Vec3d middle = (a + b + c) * (1 / 3.0);
    View view = view_from(middle + (b - a).cross(c - a).normalized() * 3, middle, 40);
    view.up = b - a;
    rays += check_no_shadow(scene, view);
  }
  CHECK(rays > 100000);
}

TEST_CASE("rays leave a patch") {
  SceneDescription scene = matte();
  // Its normals are those of its plane: others would light points that do lie in the patch's own shadow.
  const Vec3d a(-1, -1, 0), b(1, -1, 0.1), c(0.3, 1, 0);
  const Vec3d normal = (b - a).cross(c - a);
  const PatchVertex corners[] = {{a, normal}, {b, normal}, {c, normal}};
  add_patch(scene, corners, 0);
  check_around(scene, 4);
}
