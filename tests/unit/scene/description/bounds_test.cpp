#include <catch2/catch.hpp>

#include <cmath>

#include "scene/description/scene_description.h"

namespace pprt::bounds_test {

TEST_CASE("a scene without objects has an empty box") {
  CHECK(bounds(SceneDescription{}).isEmpty());
}

TEST_CASE("spheres, also those seen from inside, extend by their radius") {
  SceneDescription scene;
  add_sphere(scene, {{1, 2, 3}, -0.5, 0, {}});
  CHECK(bounds(scene) == Box3d({0.5, 1.5, 2.5}, {1.5, 2.5, 3.5}));
}

TEST_CASE("an upright cone is as wide as its base and no higher than its axis") {
  SceneDescription scene;
  add_cone(scene, {{0, 0, 1}, 2, {0, 0, 4}, 0.5, 0, {}});
  CHECK(bounds(scene) == Box3d({-2, -2, 1}, {2, 2, 4}));
}

TEST_CASE("a leaning cylinder has the exact box of its two rims") {
  SceneDescription scene;
  add_cone(scene, {{0, 0, 0}, -1, {3, 0, 4}, -1, 0, {}});
  const Box3d box = bounds(scene);
  // The unit axis is (0.6, 0, 0.8): a rim reaches sqrt(1 - 0.36) along x, sqrt(1 - 0.64) along z.
  CHECK(box.min.equalWithAbsError({-0.8, -1, -0.6}, 1e-15));
  CHECK(box.max.equalWithAbsError({3.8, 1, 4.6}, 1e-15));
}

TEST_CASE("polygons and patches extend by their vertices") {
  SceneDescription scene;
  const Vec3d polygon[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, -2}};
  const PatchVertex patch[] = {{{5, 0, 0}, {0, 0, 9}}, {{0, 6, 0}, {0, 0, 9}}, {{0, 0, 7}, {0, 0, 9}}};
  add_polygon(scene, polygon, 0);
  add_patch(scene, patch, 0);
  CHECK(bounds(scene) == Box3d({0, 0, -2}, {5, 6, 7}));
}

TEST_CASE("objects keep their order across kinds, and polygons their vertices") {
  SceneDescription scene;
  const Vec3d first[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Vec3d second[] = {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
  add_polygon(scene, first, 0);
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  add_polygon(scene, second, 0);
  CHECK(scene.order == std::vector<PrimitiveRef>{{PrimitiveKind::kPolygon, 0},
                                                 {PrimitiveKind::kSphere, 0},
                                                 {PrimitiveKind::kPolygon, 1}});
  CHECK(scene.vertices(scene.polygons[0]).size() == 3);
  REQUIRE(scene.vertices(scene.polygons[1]).size() == 4);
  CHECK(scene.vertices(scene.polygons[1])[3] == Vec3d(2, 1, 0));
}

}  // namespace pprt::bounds_test
