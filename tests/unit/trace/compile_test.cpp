#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "base/diagnostics.h"
#include "trace/compiled_scene.h"
#include "trace/geometry/normalisation.h"
#include "unit/trace/test_scenes.h"

namespace pprt::compile_test {

using namespace pprt::test;

TEST_CASE("normalising fits any box into the unit cube, exactly but for the recentring") {
  for (const double size : {1e-30, 0.3, 1.0, 1.0000001, 2.0, 24.0, 1e30}) {
    Box3d box(Vec3d(5 * size, -size, 0), Vec3d(6 * size, size / 2, size / 4));
    const Normalisation map = normalising(box);
    const Vec3d extent = map.point(box.max) - map.point(box.min);
    CAPTURE(size);
    CHECK(std::max({extent.x, extent.y, extent.z}) <= 1);
    CHECK(std::max({extent.x, extent.y, extent.z}) > 0.5);
    int exponent = 0;
    CHECK(std::frexp(map.scale, &exponent) == 0.5);
    for (int i = 0; i < 3; ++i) CHECK(std::abs(map.point(box.max)[i]) <= 0.5);
  }
  CHECK(normalising(Box3d(Vec3d(3, 3, 3), Vec3d(3, 3, 3))).point({3, 3, 3}) == Vec3d(0, 0, 0));
}

TEST_CASE("a scene with nothing to see is refused") {
  SceneDescription scene = scene_with(Material());
  CHECK_THROWS_WITH(compile(scene), Catch::Contains("no objects"));
  add_sphere(scene, {{0, 0, 0}, 0, 0, {}});
  CHECK_THROWS_WITH(compile(scene), Catch::Contains("any extent"));
}

TEST_CASE("a number that is not finite is refused, with its place") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  SceneDescription sphere = scene, cone = scene, polygon = scene, light = scene;
  add_sphere(sphere, {{0, 0, 0}, kNan, 0, {3, 1}});
  CHECK_THROWS_WITH(compile(sphere), "test:3:1: error: a coordinate or radius is not finite");
  add_cone(cone, {{kNan, 0, 0}, 1, {0, 0, 1}, 1, 0, {4, 1}});
  CHECK_THROWS_WITH(compile(cone), Catch::StartsWith("test:4:1: error: "));
  add_polygon(polygon, std::vector<Vec3d>{{0, 0, 0}, {1, kNan, 1}, {2, 2, 0}}, 0, {5, 1});
  CHECK_THROWS_WITH(compile(polygon), Catch::StartsWith("test:5:1: error: "));
  light.lights[0].position.y = std::numeric_limits<double>::infinity();
  light.lights[0].location = {2, 1};
  CHECK_THROWS_WITH(compile(light), Catch::StartsWith("test:2:1: error: "));
}

TEST_CASE("objects without extent are left out and counted in the census") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  add_sphere(scene, {{0, 0, 0}, 0, 0, {}});
  add_cone(scene, {{1, 1, 1}, 1, {1, 1, 1}, 1, 0, {}});
  add_polygon(scene, std::vector<Vec3d>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, 0);
  const CompiledScene compiled = compile(scene);
  CHECK_THAT(compiled.census(), Catch::Contains("3 without extent left out"));
  CHECK_FALSE(look(compiled, *scene.view).at_infinity);
}

TEST_CASE("objects that repeat others are left out and change no ray") {
  Material glass;
  glass.transmittance = 0.7, glass.refractive_index = 1.5, glass.specular = 0.2;
  SceneDescription once = scene_with(glass);
  once.materials.push_back(Material());
  const std::vector<PatchVertex> patch = {
      {{-3, -3, -2}, {0, 0, 1}}, {{3, -3, -2}, {0.2, 0, 1}}, {{0, 3, -2}, {0, 0.2, 1}}};
  const auto add_all = [&](SceneDescription& scene) {
    add_sphere(scene, {{0, 0.5, 0}, 1, 0, {}});
    add_sphere(scene, {{0.5, 0, 3}, -0.25, 0, {}});
    add_cone(scene, {{-1, 0, 1}, 0.5, {-1, 1, 0}, 0.25, 1, {}});
    add_square(scene, 0.4, 2, 0);
    add_patch(scene, patch, 1);
  };
  add_all(once);
  SceneDescription thrice = once;
  add_all(thrice);
  add_all(thrice);
  thrice.spheres[2].center.x = -0.0;
  const CompiledScene one = compile(once), three = compile(thrice);
  CHECK(one.repeated().count == 0);
  CHECK(three.repeated().count == 10);
  CHECK(three.repeated().first == 5);
  CHECK_THAT(three.census(), Catch::Contains("; 10 that repeat others left out"));
  Tracer a(one, one.camera(*once.view)), b(three, three.camera(*once.view));
  int hits = 0;
  for (int i = 0; i < 64 * 64; ++i) {
    const RaySample s = a.trace(i % 64 + 0.5, i / 64 + 0.5), t = b.trace(i % 64 + 0.5, i / 64 + 0.5);
    REQUIRE(s.color == t.color);
    REQUIRE(s.primitive == t.primitive);
    hits += !s.at_infinity;
  }
  CHECK(hits > 500);
}

TEST_CASE("objects that differ in anything are no repeats") {
  SceneDescription scene = scene_with(Material());
  scene.materials.push_back({.color = {1, 0, 0}});
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  add_sphere(scene, {{0, 0, 0}, -1, 0, {}});
  add_sphere(scene, {{0, 0, 0}, 1, 1, {}});
  add_sphere(scene, {{0, 0, 1e-300}, 1, 0, {}});
  add_cone(scene, {{0, 0, 0}, 1, {0, 0, 1}, 2, 0, {}});
  add_cone(scene, {{0, 0, 0}, 2, {0, 0, 1}, 1, 0, {}});
  const std::vector<Vec3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  add_polygon(scene, corners, 0);
  add_polygon(scene, std::vector<Vec3d>{corners[1], corners[2], corners[0]}, 0);
  std::vector<PatchVertex> patch = {
      {corners[0], {0, 0, 1}}, {corners[1], {0, 0, 1}}, {corners[2], {0, 0, 1}}};
  add_patch(scene, patch, 0);
  patch[2].normal = {0, 1, 1};
  add_patch(scene, patch, 0);
  CHECK(compile(scene).repeated().count == 0);
}

TEST_CASE("materials that give more light than they get are counted in the census") {
  SceneDescription scene = scene_with(Material{.color = {1, 1, 1}, .specular = 0.6, .transmittance = 0.5});
  add_square(scene, 1, 0);
  CHECK_THAT(
      compile(scene).census(),
      Catch::Contains("materials   1 in use; 1 with Ks + T above 1, brighter than what is seen in it\n"));
  scene.materials[0].transmittance = 0.4;
  CHECK_THAT(compile(scene).census(), Catch::Contains("materials   1 in use\n"));
}

TEST_CASE("the census counts what is there and names nothing else") {
  SceneDescription scene = scene_with(Material());
  add_square(scene, 1, 0);
  const std::string census = compile(scene).census();
  CHECK_THAT(census, Catch::Contains("primitives  1 polygon (2 triangles)\n"));
  CHECK_THAT(census, Catch::Contains("materials   1 in use\n"));
  CHECK_THAT(census, !Catch::Contains("sphere"));
  CHECK_THAT(census, !Catch::Contains("cone"));
}

}  // namespace pprt::compile_test
