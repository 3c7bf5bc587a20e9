// Shading of materials and lights at the ends of their ranges.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>

#include "numeric/oracle.h"
#include "numeric/pictures.h"
#include "numeric/report.h"
#include "unit/trace/test_scenes.h"

namespace pprt::extreme_shading_test {

using namespace pprt::test;

namespace {

// Returns a scene with one primitive of each kind, all of one material. A ray goes exactly through the
// sphere's centre.
SceneDescription four_kinds(const Material& material, std::initializer_list<Vec3d> lights) {
  SceneDescription scene = scene_with(material, lights);
  add_square(scene, 4, 0);
  add_sphere(scene, {{0, 0, 1}, 1, 0, {}});
  add_cone(scene, {{2, 0, 0}, 0.5, {2, 0, 2}, 0, 0, {}});
  const PatchVertex patch[] = {{{-3, -1, 1}, {0, 0, 1}}, {{-1, -1, 1}, {1, 0, 0.1}}, {{-2, 1, 1}, {0, 1, 0}}};
  add_patch(scene, patch, 0);
  return scene;
}

int not_numbers(const SceneDescription& scene) {
  int count = 0;
  for (const Rgb& c : traced_picture(scene, 33)) {
    const bool number = std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
    count += !number || c.x < 0 || c.y < 0 || c.z < 0;
  }
  return count;
}

}  // namespace

TEST_CASE("materials at the ends of their ranges give finite colours") {
  int pictures = 0, wrong = 0;
  for (const double shine : {0.0, 1e-30, 1.0, 99999.0, 100000.0, 1e30}) {
    for (const double index : {0.0, -1.0, 1e-30, 1e-9, 1.0, 1.5, 1e9, 1e30}) {
      for (const double transmittance : {0.0, 1.0}) {
        const Material material{{1, 1, 1}, 1, 1, shine, transmittance, index};
        CAPTURE(shine, index, transmittance);
        const int found = not_numbers(four_kinds(material, {{0, 0, 100}, {3, 4, 5}}));
        CHECK(found == 0);
        ++pictures, wrong += found;
      }
    }
  }
  report(
      fmt::format("{} materials at the ends of their ranges: Shine 0 to 1e30, index -1 to 1e30, Ks = T = 1",
                  pictures),
      "every colour a number, none negative", "", wrong == 0 ? "so" : fmt::format("{} pixels", wrong));
}

TEST_CASE("lights in the plane, on the surface, at the eye and far off give finite colours") {
  const Material material{{1, 1, 1}, 1, 0.5, 50, 0.5, 1.5};
  const Vec3d lights[] = {{100, 0, 0},   // in the plane of the square
                          {0, 0, 0},     // on it, where the sphere touches it
                          {0, 0, 2},     // on the sphere, where the middle ray meets it
                          {0, 0, 1},     // in its middle
                          {2, 0, 2},     // on the cone's tip
                          {0, 0, 10},    // at the eye
                          {-2, 0, 1},    // on the patch
                          {0, 0, 1e30},  // far off
                          {0, 1e150, 0}};
  int wrong = 0;
  for (const Vec3d& light : lights) {
    CAPTURE(light.x, light.y, light.z);
    const int found = not_numbers(four_kinds(material, {light}));
    CHECK(found == 0);
    wrong += found;
  }
  report("lights in the plane, on four kinds of surface, at the eye, at a tip, 1e150 away",
         "every colour a number, none negative", "", wrong == 0 ? "so" : fmt::format("{} pixels", wrong));
}

// At the critical angle the refracted ray grazes the surface, and rounding decides whether there is one. The
// ring of these pixels may differ, as edges may.
TEST_CASE("shading at its limits is that of the oracle") {
  struct Case {
    const char* name;
    Material material;
    Vec3d light;
    Vec3d eye;
  };
  const Material matte, glossy{{0.9, 0.8, 0.7}, 0.5, 0.5, 99999, 0, 1},
      dull{{0.9, 0.8, 0.7}, 0.5, 0.5, 0, 0, 1};
  const auto glass = [](double index) { return Material{{1, 1, 1}, 0.1, 0.2, 20, 0.7, index}; };
  const Vec3d above(4, 5, 6), front(0, -8, 5);
  const Case cases[] = {{"light in the plane", matte, {100, 0, 0}, front},
                        {"light grazing", matte, {50, 0, 1e-4}, front},
                        {"light grazing a sphere's top", matte, {0, 50, 1.99}, front},
                        {"light at the eye", matte, front, front},
                        {"light 1e9 away", matte, {1e9, 2e9, 3e9}, front},
                        {"Shine 99999", glossy, above, front},
                        {"Shine 0", dull, above, front},
                        {"index 0", glass(0), above, front},
                        {"index 1", glass(1), above, front},
                        {"index 0.7", glass(0.7), above, front},
                        {"index 1.0000001", glass(1.0000001), above, front},
                        {"index 5", glass(5), above, front},
                        {"total reflection, from within", glass(1.5), above, {0, 0.1, 1.1}},
                        {"total reflection, from below", glass(1.5), above, {0, -3, -0.5}},
                        {"Ks + T = 2", {{1, 1, 1}, 1, 1, 10, 1, 1.3}, above, front}};
  Worst worst;
  for (const Case& c : cases) {
    SceneDescription scene = four_kinds(c.material, {c.light});
    scene.background = Rgb(0.2, 0.3, 0.4);
    scene.view = view_from(c.eye, {0, 0, 0.7}, 45);
    scene.view->up = {0, 0, 1};
    const double share = share_different(traced_picture(scene, 96), oracle_picture(scene, 96));
    CAPTURE(c.name, share);
    CHECK(share <= 0.001);
    worst.add(share, c.name);
  }
  report(
      "15 pictures with grazing and far lights, indices from 0 to 5, the critical angle, Ks + T = 2, against "
      "long double",
      "0.1 %", "as above", worst.percent());
}

}  // namespace pprt::extreme_shading_test
