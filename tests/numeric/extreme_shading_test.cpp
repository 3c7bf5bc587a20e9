// Materials and lights at the ends of their ranges give colours that are numbers.
#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>

#include "pictures.h"
#include "test_scenes.h"

using namespace pprt;
using namespace pprt::test;

namespace {

// One primitive of each kind, all of the same material; a ray goes exactly through the sphere's middle.
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
  for (const double shine : {0.0, 1e-30, 1.0, 99999.0, 100000.0, 1e30}) {
    for (const double index : {0.0, -1.0, 1e-30, 1e-9, 1.0, 1.5, 1e9, 1e30}) {
      for (const double transmittance : {0.0, 1.0}) {
        const Material material{{1, 1, 1}, 1, 1, shine, transmittance, index};
        CAPTURE(shine, index, transmittance);
        CHECK(not_numbers(four_kinds(material, {{0, 0, 100}, {3, 4, 5}})) == 0);
      }
    }
  }
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
  for (const Vec3d& light : lights) {
    CAPTURE(light.x, light.y, light.z);
    CHECK(not_numbers(four_kinds(material, {light})) == 0);
  }
}
