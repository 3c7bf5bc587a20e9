// Which polygons count as one surface.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

#include "trace/compiled_scene.h"
#include "unit/trace/test_scenes.h"

namespace pprt::connected_surfaces_test {

using namespace pprt::test;

namespace {

std::vector<std::uint32_t> surfaces_of(const SceneDescription& scene) {
  const CompiledScene compiled = compile(scene);
  const Tracer tracer(compiled, compiled.camera(view_from({0, 0, 10}, {0, 0, 0})));
  return {tracer.surfaces().begin(), tracer.surfaces().end()};
}

// A square of side 1 with its lower left corner at (x, 0), turned up behind its left side.
void add_tile(SceneDescription& scene, double x, double slope, MaterialIndex material = 0) {
  const std::array<Vec3d, 4> corners = {{{x, 0, 0}, {x + 1, 0, slope}, {x + 1, 1, slope}, {x, 1, 0}}};
  add_polygon(scene, corners, material);
}

// A strip of quadrangles round a cylinder, with its normals.
SceneDescription strip(double bend) {
  SceneDescription scene = scene_with(Material());
  for (int i = 0; i < 12; ++i) {
    std::vector<PatchVertex> corners;
    for (const auto& [k, z] : {std::pair(i, 0.0), {i + 1, 0.0}, {i + 1, 1.0}, {i, 1.0}}) {
      const double turn = bend * k;
      const Vec3d out(std::cos(turn), std::sin(turn), 0);
      corners.push_back({out + Vec3d(0, 0, z), out});
    }
    add_patch(scene, corners, 0);
  }
  return scene;
}

}  // namespace

TEST_CASE("surfaces: what lies in one plane and meets at a corner is one, another plane or material is not") {
  SceneDescription scene = scene_with(Material());
  scene.materials.emplace_back();
  add_tile(scene, 0, 0);
  add_tile(scene, 1, 0);
  add_tile(scene, 2, 0.5);    // bends up
  add_tile(scene, -1, 0, 1);  // another material
  add_tile(scene, 10, 0);     // far away
  add_sphere(scene, {{0, 0, -3}, 1, 0, {}});
  CHECK(surfaces_of(scene) == std::vector<std::uint32_t>{0, 1, 1, 3, 4, 5, 6});
}

TEST_CASE("surfaces: patches with common normals are one, however far they bend") {
  const std::vector<std::uint32_t> surfaces = surfaces_of(strip(0.5));
  CHECK(std::set<std::uint32_t>(surfaces.begin() + 1, surfaces.end()).size() == 1);
}

TEST_CASE("surfaces: the same shape without normals has as many as facets") {
  SceneDescription flat = strip(0.5);
  for (PatchVertex& v : flat.patch_vertices) v.normal = Vec3d(0, 0, 0);
  const std::vector<std::uint32_t> surfaces = surfaces_of(flat);
  CHECK(std::set<std::uint32_t>(surfaces.begin() + 1, surfaces.end()).size() == 12);
}

}  // namespace pprt::connected_surfaces_test
