// Position, size and orientation of a scene must not change its picture.
#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "numeric/pictures.h"
#include "numeric/report.h"
#include "unit/trace/test_scenes.h"

namespace pprt::far_scenes_test {

using namespace pprt::test;

namespace {

constexpr int kSize = 128;

// Rays that pass an edge on the other side. Measured: at most 2 pixels of 16384 (balls).
constexpr double kShareOfEdges = 0.001;

constexpr const char* kBound = "0.1 %";

// Applies a linear map that keeps lengths. `mirror`: the map mirrors the scene, so windings are reversed too,
// for the inside of glass.
SceneDescription turned(const SceneDescription& scene, const Imath::M33d& map, bool mirrors) {
  SceneDescription result = scene;
  const auto turn = [&](Vec3d& p) { p = p * map; };
  for (Sphere& s : result.spheres) turn(s.center);
  for (Cone& c : result.cones) turn(c.base), turn(c.apex);
  for (Vec3d& v : result.polygon_vertices) turn(v);
  for (PatchVertex& v : result.patch_vertices) turn(v.position), turn(v.normal);
  for (Light& l : result.lights) turn(l.position);
  for (Vec3d* v : {&result.view->from, &result.view->at, &result.view->up}) turn(*v);
  if (!mirrors) return result;
  for (const Polygon& p : result.polygons) {
    const auto first = result.polygon_vertices.begin() + p.first_vertex;
    std::reverse(first, first + p.vertex_count);
  }
  for (const Patch& p : result.patches) {
    const auto first = result.patch_vertices.begin() + p.first_vertex;
    std::reverse(first, first + p.vertex_count);
  }
  return result;
}

// Mirrors a picture left to right.
std::vector<Rgb> turned_over(std::vector<Rgb> picture) {
  for (auto row = picture.begin(); row != picture.end(); row += kSize) std::reverse(row, row + kSize);
  return picture;
}

}  // namespace

TEST_CASE("a tiny or huge scene gives the picture that it gives at home") {
  Worst worst;
  for (const SceneDescription& scene : spd_scenes()) {
    const std::vector<Rgb> home = traced_picture(scene, kSize);
    for (const double scale : {1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9}) {
      const double share = share_different(home, traced_picture(moved(scene, {0, 0, 0}, scale), kSize));
      CAPTURE(scene.name, scale);
      CHECK(share <= kShareOfEdges);
      worst.add(share, scene.name);
    }
  }
  report("nine SPD scenes scaled by 1e-9, 1e-6 ... 1e9 against themselves, 128 x 128", kBound,
         "scaled to size 1 by a power of two, which rounds nothing", worst.percent());
}

// A coordinate at 1e9 is rounded by up to 2^-24 before the renderer sees it. The renderer rounds by up to
// 2^-25 of the scene's size, raised to a power of two. For the smallest scene here, of size 1.5, that is
// 2^-24 again.
TEST_CASE("a scene up to 1e9 away gives the picture that it gives at home") {
  Worst worst;
  for (const SceneDescription& scene : spd_scenes()) {
    const std::vector<Rgb> home = traced_picture(scene, kSize);
    for (const double by : {1e3, 1e6, 1e9}) {
      const double share = share_different(home, traced_picture(moved(scene, {by, -by, by}, 1), kSize));
      CAPTURE(scene.name, by);
      CHECK(share <= kShareOfEdges);
      worst.add(share, scene.name);
    }
  }
  report("the same moved by 1e3, 1e6, 1e9", kBound,
         "at 1e9 a coordinate is rounded by 2^-24, as the tracer rounds the smallest of them (size 1.5)",
         worst.percent());
}

// Farther away, the file itself has lost digits. Moving the scene back is exact, so both scenes have lost the
// same and give the same picture (measured: no pixel differs). The undamaged scene differs in up to 0.8 % of
// the pixels.
TEST_CASE("a scene farther away loses only what its coordinates have lost") {
  Worst worst;
  for (const SceneDescription& scene : spd_scenes()) {
    for (const double by : {1e9, 1e11, 1e12}) {
      const SceneDescription far = moved(scene, {by, -by, by}, 1);
      const SceneDescription brought_home = moved(far, {-by, by, -by}, 1);
      const double share = share_different(traced_picture(brought_home, kSize), traced_picture(far, kSize));
      CAPTURE(scene.name, by);
      CHECK(share <= kShareOfEdges);
      worst.add(share, scene.name);
    }
  }
  report("moved by up to 1e12 against the same brought back", kBound,
         "coordinates have lost 6e-5, nobody can tell what; bringing them back is exact", worst.percent());
}

TEST_CASE("a scene that is turned gives the same picture, a mirrored one the mirrored picture") {
  const Imath::M33d third(0, 1, 0, 0, 0, 1, 1, 0, 0);  // x to y to z
  const Imath::M33d slanted(1 / 3., 2 / 3., 2 / 3., 2 / 3., 1 / 3., -2 / 3., -2 / 3., 2 / 3., -1 / 3.);
  const Imath::M33d mirror(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  Worst turns, mirrors;
  for (const SceneDescription& scene : spd_scenes()) {
    const std::vector<Rgb> home = traced_picture(scene, kSize);
    for (const Imath::M33d& map : {third, slanted}) {
      const double share = share_different(home, traced_picture(turned(scene, map, false), kSize));
      CAPTURE(scene.name);
      CHECK(share <= kShareOfEdges);
      turns.add(share, scene.name);
    }
    for (const Imath::M33d& map : {mirror, mirror * slanted}) {
      const double share =
          share_different(turned_over(home), traced_picture(turned(scene, map, true), kSize));
      CAPTURE(scene.name);
      CHECK(share <= kShareOfEdges);
      mirrors.add(share, scene.name);
    }
  }
  report("turned, along the axes and askew", kBound, "other roundings of every coordinate", turns.percent());
  report("mirrored, likewise, against the mirrored picture", kBound, "as above", mirrors.percent());
}

}  // namespace pprt::far_scenes_test
