// Compares single objects with the output of the SPD programs, to their six digits, and checks geometry that
// a wrong generator would not have.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "spd/spd.h"

namespace pprt::spd_spots_test {

namespace {

void append(std::vector<double>& out, const Vec3d& v) {
  out.insert(out.end(), {v.x, v.y, v.z});
}

// The numbers of the index-th object in the order in which NFF gives them.
std::vector<double> object_numbers(const SceneDescription& scene, std::size_t index) {
  const PrimitiveRef ref = scene.order.at(index);
  std::vector<double> out;
  if (ref.kind == PrimitiveKind::kSphere) {
    append(out, scene.spheres.at(ref.index).center);
    out.push_back(scene.spheres.at(ref.index).radius);
  } else if (ref.kind == PrimitiveKind::kCone) {
    const Cone& cone = scene.cones.at(ref.index);
    append(out, cone.base);
    out.push_back(cone.base_radius);
    append(out, cone.apex);
    out.push_back(cone.apex_radius);
  } else if (ref.kind == PrimitiveKind::kPolygon) {
    for (const Vec3d& v : scene.vertices(scene.polygons.at(ref.index))) append(out, v);
  } else {
    for (const PatchVertex& v : scene.vertices(scene.patches.at(ref.index))) {
      append(out, v.position);
      append(out, v.normal);
    }
  }
  return out;
}

struct Spot {
  const char* name;
  int size;
  std::size_t object;
  std::vector<double> numbers;
};

// The height of the mountain at a point of its grid.
double height_at(const SceneDescription& scene, double x, double y) {
  const auto found = std::find_if(scene.polygon_vertices.begin(), scene.polygon_vertices.end(),
                                  [x, y](const Vec3d& v) { return v.x == x && v.y == y; });
  if (found == scene.polygon_vertices.end()) throw std::out_of_range("no such vertex");
  return found->z;
}

}  // namespace

TEST_CASE("objects equal those of the SPD programs") {
  const Spot spot = GENERATE(values<Spot>({
      {"balls", 2, 1, {0, 0, 0, 0.5}},
      {"balls", 2, 30, {0.172546, 0.643951, 0.222222, 0.0555556}},
      {"balls", 2, 62, {0.0996195, -0.371785, 0.544331, 0.166667}},
      {"balls", 2, 91, {0.471405, -0.471405, -0.222222, 0.0555556}},
      {"gears",
       1,
       49,
       {-0.408591, 0.801906, 1, -0.408591, 0.801906, 0.9, -0.468657, 0.877716, 0.9, -0.468657, 0.877716, 1}},
      {"gears",
       1,
       99,
       {-0.468657, -0.877716, 1, -0.468657, -0.877716, 0.9, -0.408591, -0.801906, 0.9, -0.408591, -0.801906,
        1}},
      {"jacks", 2, 1, {0, -0.649519, 0.375, 0.075, 0, 0.649519, -0.375, 0.075}},
      {"jacks", 2, 27, {-0.651221, 0.0484557, -0.916072, 0.0375, 0.0535485, 0.176713, -0.693924, 0.0375}},
      {"jacks", 2, 55, {0.298836, -0.437344, 0.992498, 0.0375, 0.298836, 0.212175, 0.617498, 0.0375}},
      {"jacks", 2, 80, {0.427094, 0.577249, -0.000176223, 0.075}},
      {"lattice", 1, 1, {0.12375, 0, 0, 0.0625, 0.87625, 0, 0, 0.0625}},
      {"lattice", 1, 14, {1, 0, 0.12375, 0.0625, 1, 0, 0.87625, 0.0625}},
      {"lattice", 1, 19, {1, 1, 1, 0.25}},
      {"mount", 4, 1, {-0.661196, 0.661196, 0.930598, 0.17}},
      {"mount", 4, 172, {0.75, -1, -0.427208, 0.875, -1, -0.13904, 0.875, -0.875, -0.12082}},
      {"mount", 4, 345, {1, 1, 0, 0.875, 1, -0.0311874, 0.875, 0.875, -0.0438567}},
      {"mount", 4, 515, {-0.875, 1, -0.0309481, -1, 1, 0, -1, 0.875, 0.0897349}},
      {"rings", 1, 1, {0.930995, 2.61313, 0, 0.07412, 0.287693, 1.7277, 0, 0.07412}},
      {"rings", 1, 20, {0.465497, 2.46188, -0.791951, 0.07412}},
      {"rings", 1, 41, {-0.287693, 1.7277, 0, 0.07412, -0.465497, 2.46188, -0.791951, 0.07412}},
      {"rings", 1, 60, {0, 2.12367, -0.791951, 0.07412}},
      {"teapot", 2, 1, {0, -4, 0, 4, -4, 0, 4, 0, 0, 0, 0, 0}},
      {"teapot",
       2,
       81,
       {-1.065, -1.065, 0.15, -0.707107, -0.707107, 0, 0, -1.5, 0.15, 0, -1, 0, 0, -1.75, 0.384375, 0,
        -0.6981, -0.716}},
      {"teapot",
       2,
       163,
       {2.8, 0, 2.4, 0.6, 0, -0.8, 3, 0.1125, 2.4, 0, -1, 0, 3.12656, 0.15, 2.4668, -0.0348909, 0.0594438,
        0.997622}},
      {"teapot",
       2,
       243,
       {1.5, 0, 0.15, 1, 0, 0, 1.065, -1.065, 0.15, 0.707107, -0.707107, 0, 0.911906, -0.911906, 0.046875,
        0.0996006, -0.0996006, -0.99003}},
      {"tetra", 3, 1, {-0.5, -0.5, 1, -0.5, -1, 0.5, -1, -0.5, 0.5}},
      {"tetra", 3, 21, {-0.5, 1, -0.5, -0.5, 0.5, -1, -1, 1, -1}},
      {"tetra", 3, 43, {0.5, -0.5, -1, 0.5, -1, -0.5, 1, -0.5, -0.5}},
      {"tetra", 3, 63, {0.5, 1, 0.5, 0.5, 0.5, 1, 1, 1, 1}},
      {"tree", 4, 1, {0, 0, 0, 0.15, 0, 0, 1, 0.1005}},
      {"tree", 4, 21, {0.588193, -0.147304, 1.89327, 0.0451145, 0.784589, -0.342847, 1.99652, 0.0302267}},
      {"tree", 4, 43, {-0.527457, 0.0607989, 1.95031, 0.0451145, -0.765302, 0.104682, 2.15754, 0.0302267}},
      {"tree", 4, 62, {-0.282123, 0.440267, 2.64633, 0.0202519}},
  }));
  CAPTURE(spot.name, spot.object);
  const std::vector<double> numbers = object_numbers(make_spd(spot.name, spot.size), spot.object);
  REQUIRE(numbers.size() == spot.numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    // Two roundings of a sixth digit.
    CHECK(std::abs(numbers[i] - spot.numbers[i]) <= 1.1e-5 * std::max(1.0, std::abs(spot.numbers[i])));
  }
}

TEST_CASE("mount: a height is the roughness times the grid point's own noise") {
  const SceneDescription scene = make_spd("mount", 6);
  const double rise = 0.509824528534;
  CHECK(height_at(scene, 0, -1) == Approx(rise * -1.07507593112).epsilon(1e-10));
  CHECK(height_at(scene, -1, 0) == Approx(rise * -0.617354435556).epsilon(1e-10));
}

TEST_CASE("balls: children touch their parent") {
  const SceneDescription scene = make_spd("balls", 2);
  // Depth first: the second sphere and its nine children follow the first.
  for (std::size_t i = 1; i <= 10; ++i) {
    const Sphere& parent = scene.spheres[i == 1 ? 0 : 1];
    const Sphere& child = scene.spheres[i];
    CHECK(child.radius == Approx(parent.radius / 3).epsilon(1e-14));
    CHECK((child.center - parent.center).length() == Approx(parent.radius + child.radius).epsilon(1e-14));
  }
}

TEST_CASE("mount: the four glass spheres touch one another") {
  const SceneDescription scene = make_spd("mount", 1);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = (scene.spheres[i].center - scene.spheres[j].center).length();
      // The circumradius is given as sqrt(3/2) times the radius: exact for a regular tetrahedron.
      CHECK(distance == Approx(2 * 0.17).epsilon(1e-14));
    }
  }
}

TEST_CASE("rings: a cluster is six pentagons of equal edges") {
  const SceneDescription scene = make_spd("rings", 1);
  const double edge = (scene.cones[0].apex - scene.cones[0].base).length();
  for (const Cone& cone : scene.cones) {
    CHECK((cone.apex - cone.base).length() == Approx(edge).epsilon(1e-13));
  }
}

TEST_CASE("teapot: normals of the body point away from its axis, those of the bottom down") {
  const SceneDescription scene = make_spd("teapot", 12);
  const std::size_t per_patch = 2 * 12 * 12;
  for (std::size_t i = 4 * per_patch; i < 12 * per_patch; ++i) {  // after the rim's four patches
    for (const PatchVertex& v : scene.vertices(scene.patches[i])) {
      REQUIRE(v.normal.x * v.position.x + v.normal.y * v.position.y > 0);
    }
  }
  const std::size_t bottom = scene.patches.size() - 4 * (per_patch - 12);
  for (std::size_t i = bottom; i < scene.patches.size(); ++i) {
    for (const PatchVertex& v : scene.vertices(scene.patches[i])) REQUIRE(v.normal.z < 1e-9);
  }
}

TEST_CASE("lattice: rods end inside the spheres they join") {
  const SceneDescription scene = make_spd("lattice", 3);
  const double sphere_radius = scene.spheres[0].radius;
  for (const Cone& rod : scene.cones) {
    const double gap = (1.0 / 3 - (rod.apex - rod.base).length()) / 2;  // sphere centre to rod end
    CHECK(gap > 0);
    CHECK(std::hypot(gap, rod.base_radius) < sphere_radius);
  }
}

}  // namespace pprt::spd_spots_test
