// What each database is as a whole: objects by kind, box, view, lights, materials.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "spd/spd.h"

namespace pprt::spd_scenes_test {

namespace {

struct Counts {
  std::size_t spheres, cones, polygons, patches;

  friend bool operator==(const Counts&, const Counts&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Counts& c) {
    return out << c.spheres << " spheres, " << c.cones << " cones, " << c.polygons << " polygons, "
               << c.patches << " patches";
  }
};

Counts counts(const SceneDescription& scene) {
  return {scene.spheres.size(), scene.cones.size(), scene.polygons.size(), scene.patches.size()};
}

struct Whole {
  const char* name;
  Counts counts;
  std::size_t lights, materials;
};

bool finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

TEST_CASE("default sizes have the published numbers of objects, lights and materials") {
  const auto [name, expected, lights, materials] = GENERATE(values<Whole>({
      {"tree", {4095, 4095, 1, 0}, 7, 2},
      {"balls", {7381, 0, 1, 0}, 3, 2},
      {"gears", {0, 0, 9345, 0}, 5, 63},
      {"mount", {4, 0, 8192, 0}, 1, 2},
      {"rings", {4200, 4200, 1, 0}, 3, 7},
      {"tetra", {0, 0, 4096, 0}, 1, 1},
      {"teapot", {0, 0, 144, 9120}, 2, 3},
      {"jacks", {6, 3, 0, 0}, 1, 1},
      {"lattice", {2197, 6084, 0, 0}, 6, 4},
  }));
  CAPTURE(name);
  const SceneDescription scene = make_spd(name);
  CHECK(counts(scene) == expected);
  CHECK(scene.lights.size() == lights);
  CHECK(scene.materials.size() == materials);
}

TEST_CASE("the closed formula counts the objects, and every object has its place") {
  for (const SpdDatabase& database : spd_databases()) {
    for (int size = 1; size <= 4; ++size) {
      const SceneDescription scene = make_spd(database.name, size);
      CAPTURE(scene.name);
      const Counts c = counts(scene);
      CHECK(static_cast<double>(scene.primitive_count()) == spd_primitive_count(database.name, size));
      CHECK(scene.primitive_count() == c.spheres + c.cones + c.polygons + c.patches);
      const Box3d box = bounds(scene);
      CHECK((finite(box.min) && finite(box.max)));
      const auto unit = [](const PatchVertex& v) { return std::abs(v.normal.length() - 1) < 1e-12; };
      CHECK(std::all_of(scene.patch_vertices.begin(), scene.patch_vertices.end(), unit));
    }
  }
}

TEST_CASE("every database of another size has the expected objects of each kind") {
  CHECK(counts(make_spd("tree", 1)) == Counts{3, 3, 1, 0});
  CHECK(counts(make_spd("balls", 1)) == Counts{10, 0, 1, 0});
  CHECK(counts(make_spd("gears", 2)) == Counts{0, 0, 1169, 0});
  CHECK(counts(make_spd("mount", 8)) == Counts{4, 0, 131072, 0});
  CHECK(counts(make_spd("rings", 3)) == Counts{420, 420, 1, 0});
  CHECK(counts(make_spd("teapot", 1)) == Counts{0, 0, 1, 56});
  CHECK(counts(make_spd("teapot", 3)) == Counts{0, 0, 9, 552});
  CHECK(counts(make_spd("jacks", 4)) == Counts{3510, 1755, 0, 0});
  CHECK(counts(make_spd("lattice", 3)) == Counts{64, 144, 0, 0});
}

TEST_CASE("gears are 144-gons joined by quadrilaterals, some of them glass") {
  const SceneDescription scene = make_spd("gears", 4);
  std::array<std::size_t, 145> by_vertices{};
  std::size_t transmitting = 0;
  for (const Polygon& polygon : scene.polygons) {
    ++by_vertices.at(polygon.vertex_count);
    if (scene.materials[polygon.material].transmittance > 0) ++transmitting;
  }
  CHECK(by_vertices[144] == 128);
  CHECK(by_vertices[4] == 9217);
  CHECK(transmitting == 1898);
}

TEST_CASE("every database has the expected bounding box") {
  struct Expected {
    const char* name;
    Vec3d min, max;
  };
  const auto [name, min, max] = GENERATE(values<Expected>({
      {"balls", {-12, -12, -0.5}, {12, 12, 0.831}},
      {"gears", {-2, -2, 0}, {2, 2, 1}},
      {"mount", {-1.16, -1, -0.703}, {1, 1.16, 1.378}},
      {"rings", {-10.84, 1.65, -9.34}, {8.84, 20.91, 10.34}},
      {"teapot", {-4, -4, 0}, {4, 4, 3.15}},
      {"tetra", {-1, -1, -1}, {1, 1, 1}},
      {"tree", {-50, -50, 0}, {50, 50, 3.14}},
      {"lattice", {-0.0208, -0.0208, -0.0208}, {1.0208, 1.0208, 1.0208}},
  }));
  CAPTURE(name);
  const Box3d box = bounds(make_spd(name));
  // The expected figures are rounded in their last digit shown, at most a hundredth.
  CHECK(box.min.equalWithAbsError(min, 0.0051));
  CHECK(box.max.equalWithAbsError(max, 0.0051));
}

TEST_CASE("every database has the expected view") {
  struct Expected {
    const char* name;
    Vec3d from, at, up;
    double angle, hither;
    int resolution;
  };
  const Expected e = GENERATE(values<Expected>({
      {"balls", {2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, 45, 0.01, 512},
      {"gears", {-1.1, -2.1, 2.6}, {0, 0, 0}, {0, 0, 1}, 45, 1, 512},
      {"mount", {-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, 45, 0.01, 512},
      {"rings", {-1, -2.61312593, 0.5}, {-1, -1.61312593, 0.5}, {0, 0, 1}, 45, 1, 512},
      {"teapot", {4.86, 7.2, 5.4}, {0, 0, 0}, {0, 0, 1}, 45, 1, 512},
      {"tetra",
       {1.022846, -3.177154, -2.174512},
       {-0.004103, -0.004103, 0.216539},
       {-0.816497, -0.816497, 0.816497},
       45,
       1,
       512},
      {"tree", {4.5, 0.4, 2}, {0, 0, 1.5}, {0, 0, 1}, 45, 1, 512},
      {"jacks", {0, 0, -8}, {0, 0, 0}, {0, 1, 0}, 25, 0.001, 256},
      {"lattice", {6.5 / 12, 1, 1 - 1.0 / 24}, {6.5 / 12, -1, -1 - 1.0 / 24}, {0.2, 1, 0}, 60, 0, 512},
  }));
  CAPTURE(e.name);
  const SceneDescription scene = make_spd(e.name);
  REQUIRE(scene.view);
  CHECK(scene.view->from.equalWithAbsError(e.from, 1e-8));
  CHECK(scene.view->at.equalWithAbsError(e.at, 1e-8));
  CHECK(scene.view->up == e.up);
  CHECK(scene.view->angle_degrees == e.angle);
  CHECK(scene.view->hither == e.hither);
  CHECK(scene.view->width == e.resolution);
  CHECK(scene.view->height == e.resolution);
  const bool is_jacks = e.name == std::string("jacks");
  CHECK(scene.background == (is_jacks ? Rgb(0.2, 0.05, 0.2) : Rgb(0.078, 0.361, 0.753)));
}

TEST_CASE("highlights become Phong exponents") {
  const auto exponent = [](const char* name, std::size_t material) {
    return make_spd(name, 1).materials.at(material).shine;
  };
  CHECK(exponent("balls", 0) == 100000);  // none
  CHECK(exponent("balls", 1) == Approx(3.0827).margin(1e-5));
  CHECK(exponent("teapot", 0) == Approx(4.81884).margin(1e-5));
  CHECK(exponent("jacks", 0) == Approx(11.1434).margin(1e-4));
  CHECK(exponent("mount", 0) == Approx(101.148).margin(1e-3));
}

TEST_CASE("the glass of mount refracts, the sphereflake mirrors, the tree does neither") {
  const SceneDescription mount = make_spd("mount", 1);
  const Material& glass = mount.materials[mount.spheres[0].material];
  CHECK(glass.transmittance == 0.9);
  CHECK(glass.refractive_index == 1.5);
  CHECK(glass.specular == 0.1);

  const SceneDescription balls = make_spd("balls", 1);
  CHECK(balls.materials[balls.spheres[0].material].specular == 0.5);
  CHECK(balls.materials[balls.polygons[0].material].specular == 0);

  for (const Material& m : make_spd("tree", 1).materials) CHECK(m.specular + m.transmittance == 0);
}

}  // namespace pprt::spd_scenes_test
