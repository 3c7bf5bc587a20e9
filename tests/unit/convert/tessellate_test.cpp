#include "convert/surfaces/tessellate.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "base/diagnostics.h"
#include "spd/spd.h"

namespace pprt::tessellate_test {

namespace {

struct Corners {
  PatchVertex a, b, c;
  Vec3d twice_area() const { return (b.position - a.position).cross(c.position - a.position); }
};

std::vector<Corners> corners(const Surface& surface) {
  std::vector<Corners> result;
  for (const TriangleIndices& t : surface.triangles) {
    result.push_back({surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]});
  }
  return result;
}

double area(const Surface& surface) {
  double sum = 0;
  for (const Corners& t : corners(surface)) sum += 0.5 * t.twice_area().length();
  return sum;
}

// Every triangle looks where the normals of its corners point, and these are of unit length.
void check_orientation(const Surface& surface) {
  for (const Corners& t : corners(surface)) {
    const Vec3d facing = t.twice_area();
    REQUIRE(facing.length() > 0);
    for (const PatchVertex& v : {t.a, t.b, t.c}) {
      CHECK(facing.dot(v.normal) > 0);
      CHECK(v.normal.length() == Approx(1));
    }
  }
}

// How far the triangle's plane lies inside a sphere of this radius about the origin.
double depth(const Corners& t, double radius) {
  return radius - t.twice_area().normalized().dot(t.a.position);
}

SceneDescription one_of_each() {
  SceneDescription scene;
  scene.materials = {{}, {Rgb(1, 0, 0), 1, 0, 0, 0, 1}};
  const Vec3d triangle[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  add_polygon(scene, triangle, 1);
  add_sphere(scene, {{0, 0, 0}, 2, 0, {}});
  add_cone(scene, {{0, 0, 0}, 1, {0, 0, 3}, 0.5, 1, {}});
  add_cone(scene, {{0, 0, 0}, 1, {0, 0, 3}, 0, 1, {}});
  return scene;
}

}  // namespace

TEST_CASE(
    "a tessellated sphere has six faces of N x N x 2 triangles, vertices on the surface, normals outwards") {
  for (const int n : {1, 2, 3, 6}) {
    CAPTURE(n);
    const Surface surface = tessellate(Sphere{{1, 2, 3}, 2, 0, {}}, n);
    CHECK(surface.triangles.size() == static_cast<std::size_t>(12 * n * n));
    for (const PatchVertex& v : surface.vertices) {
      CHECK((v.position - Vec3d(1, 2, 3)).length() == Approx(2));
      CHECK(((v.position - Vec3d(1, 2, 3)) / 2 - v.normal).length() < 1e-15);
    }
    check_orientation(surface);
  }
  CHECK(area(tessellate(Sphere{{0, 0, 0}, 1, 0, {}}, 1)) == Approx(8));  // a cube of edge 2/sqrt(3)
  CHECK(area(tessellate(Sphere{{0, 0, 0}, 1, 0, {}}, 100)) == Approx(4 * M_PI).epsilon(1e-4));
}

TEST_CASE("a tessellated sphere's cells are cut along the shorter diagonal") {
  for (int n = 1; n <= 7; ++n) {
    const Surface surface = tessellate(Sphere{{0, 0, 0}, 1, 0, {}}, n);
    REQUIRE(surface.triangles.size() == static_cast<std::size_t>(12 * n * n));
    for (std::size_t i = 0; i < surface.triangles.size(); i += 2) {
      std::vector<Vec3d> both, alone;  // the corners that two triangles share, and the others
      const TriangleIndices &a = surface.triangles[i], &b = surface.triangles[i + 1];
      for (const TriangleIndices* t : {&a, &b}) {
        const TriangleIndices& other = t == &a ? b : a;
        for (const std::uint32_t corner : *t) {
          const bool is_shared = std::count(other.begin(), other.end(), corner) > 0;
          (is_shared ? both : alone).push_back(surface.vertices[corner].position);
        }
      }
      REQUIRE((both.size() == 4 && alone.size() == 2));
      const Vec3d& from = both[0];
      const Vec3d to = both[1];
      INFO("n " << n << ", cell " << i / 2);
      CHECK((from - to).length() <= (alone[0] - alone[1]).length() + 1e-9);
    }
  }
}

TEST_CASE("a tessellated cone is a ring of 4N x 2 triangles with slanted normals and without caps") {
  const Cone cone{{1, 1, 1}, 2, {1, 1, 4}, 0.5, 0, {}};
  const Surface surface = tessellate(cone, 3);
  CHECK(surface.triangles.size() == 24);
  check_orientation(surface);
  for (const PatchVertex& v : surface.vertices) {
    const Vec3d radial(v.position.x - 1, v.position.y - 1, 0);
    CHECK(radial.length() == Approx(v.position.z == 1 ? 2 : 0.5));
    CHECK(v.normal.z == Approx(1.5 / std::hypot(1.5, 3)));  // falls by 1.5 over 3
  }
  const double slant = std::hypot(1.5, 3);
  CHECK(area(tessellate(cone, 200)) == Approx(M_PI * 2.5 * slant).epsilon(1e-4));
}

TEST_CASE("the tip of a tessellated cone has no triangles without area") {
  CHECK(tessellate(Cone{{0, 0, 0}, 1, {0, 1, 0}, 0, 0, {}}, 2).triangles.size() == 8);
  CHECK(tessellate(Cone{{0, 0, 0}, 0, {0, 1, 0}, 1, 0, {}}, 2).triangles.size() == 8);
  check_orientation(tessellate(Cone{{0, 0, 0}, 1, {1, 1, 1}, 0, 0, {}}, 2));
}

TEST_CASE("a surface visible from the inside only has normals inwards") {
  const Surface sphere = tessellate(Sphere{{0, 0, 0}, -2, 0, {}}, 2);
  check_orientation(sphere);
  CHECK(sphere.vertices[0].normal.dot(sphere.vertices[0].position) < 0);
  const Surface cone = tessellate(Cone{{0, 0, 0}, -1, {0, 0, 1}, -1, 0, {}}, 2);
  check_orientation(cone);
  CHECK(cone.vertices[0].normal.dot(cone.vertices[0].position) < 0);
}

TEST_CASE("the chord error holds with the least N, for odd N") {
  for (const double error : {0.9, 0.3, 0.1, 0.03, 0.01, 0.001}) {
    CAPTURE(error);
    const Fineness fineness{1, error};
    const Sphere sphere{{0, 0, 0}, 1, 0, {}};
    const int n = divisions(sphere, fineness);
    double deepest = 0;
    for (const Corners& t : corners(tessellate(sphere, n))) deepest = std::max(deepest, depth(t, 1));
    CHECK(deepest <= error);
    const int coarser = n % 2 == 0 ? n - 1 : n - 2;
    if (coarser >= 1) {
      deepest = 0;
      for (const Corners& t : corners(tessellate(sphere, coarser))) deepest = std::max(deepest, depth(t, 1));
      CHECK(deepest > error);
    }
    const Cone cylinder{{0, 0, 0}, 1, {0, 0, 1}, 1, 0, {}};
    const int around = divisions(cylinder, fineness);
    CHECK(1 - std::cos(M_PI / (4 * around)) <= error * (1 + 1e-12));
    if (around > 1) CHECK(1 - std::cos(M_PI / (4 * (around - 1))) > error);
  }
}

TEST_CASE("with a chord error each object is divided as its own size needs") {
  const Fineness fineness{5, 0.001};
  CHECK(divisions(Sphere{{0, 0, 0}, 0.0005, 0, {}}, fineness) == 1);
  CHECK(divisions(Cone{{0, 0, 0}, 0.0005, {1, 0, 0}, 0.0004, 0, {}}, fineness) == 1);
  CHECK(divisions(Sphere{{0, 0, 0}, 100, 0, {}}, fineness) >
        divisions(Sphere{{0, 0, 0}, 1, 0, {}}, fineness));
  CHECK(divisions(Sphere{{0, 0, 0}, 1e30, 0, {}}, fineness) == kMaxDivisions);
  CHECK(divisions(Sphere{{0, 0, 0}, 0, 0, {}}, fineness) == 0);
  CHECK(divisions(Cone{{0, 0, 0}, 1, {0, 0, 0}, 1, 0, {}}, fineness) == 0);
}

TEST_CASE("what a node makes larger is divided more finely, by the chord error that shows") {
  const auto patches = [](double factor) {
    SceneDescription scene;
    scene.materials = {{}};
    add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
    scene.movement.nodes.push_back({.parent = 0,
                                    .to_parent = {{factor, 0, 0}, {0, factor, 0}, {0, 0, factor}, {0, 0, 0}},
                                    .track = {},
                                    .location = {}});
    scene.nodes = {1};
    return tessellated(scene, {1, 0.01}).patches.size();
  };
  CHECK(patches(10) > 5 * patches(1));
}

TEST_CASE("a tessellated scene has patches in place of spheres and cones, with their materials") {
  const SceneDescription scene = one_of_each();
  const SceneDescription result = tessellated(scene, {2, {}});
  CHECK(triangle_count(scene, {2, {}}) == 48 + 16 + 8);
  CHECK(result.patches.size() == 48 + 16 + 8);
  CHECK(result.polygons.size() == 1);
  CHECK(result.spheres.empty());
  CHECK(result.cones.empty());
  CHECK(result.order.front() == PrimitiveRef{PrimitiveKind::kPolygon, 0});
  CHECK(result.patches[47].material == 0);
  CHECK(result.patches[48].material == 1);
}

TEST_CASE(
    "of spheres and cones those that a node stretches become triangles, the others stay, in their order") {
  SceneDescription scene = one_of_each();
  add_sphere(scene, {{0, 0, 0}, 1, 1, {}});
  scene.movement.nodes.push_back({.parent = 0, .to_parent = {{1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {0, 0, 0}}});
  scene.nodes = {0, 0, 0, 1, 1};
  const SceneDescription result = with_stretched_tessellated(scene, {2, {}});
  CHECK((result.spheres.size() == 1 && result.spheres[0].radius == 2));
  REQUIRE(result.cones.size() == 1);
  CHECK((result.cones[0].apex_radius == 0.5 && result.cones[0].material == 1));
  CHECK((result.polygons.size() == 1 && result.patches.size() == 8 + 48));
  CHECK(result.order[1] == PrimitiveRef{PrimitiveKind::kSphere, 0});
  CHECK(result.order[2] == PrimitiveRef{PrimitiveKind::kCone, 0});
  CHECK(result.patches[7].material == 1);
}

TEST_CASE("the tree of size 4 with N = 6 has the triangle count that SPD gives") {
  const SceneDescription scene = make_spd("tree", 4);  // 31 spheres, 31 cones, a polygon
  CHECK(tessellated(scene, {6, {}}).primitive_count() == 31 * (12 * 36 + 8 * 6) + 1);
}

TEST_CASE("a scene of more than the largest number of triangles is refused") {
  SceneDescription scene = one_of_each();
  for (int i = 0; i < 2; ++i) add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  scene.name = "a.nff";
  CHECK_THROWS_WITH(
      tessellated(scene, {1000, {}}),
      "a.nff: error: its spheres and cones would become 36012000 triangles, more than 20000000: cut "
      "them less finely");
}

}  // namespace pprt::tessellate_test
