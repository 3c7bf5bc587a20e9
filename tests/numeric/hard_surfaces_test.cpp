// Rays and surfaces at their limits, compared with the brute-force tracer in long double.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "numeric/oracle.h"
#include "numeric/pictures.h"
#include "numeric/report.h"
#include "unit/trace/test_scenes.h"

namespace pprt::hard_surfaces_test {

using namespace pprt::test;

namespace {

constexpr int kSize = 96;

// A ray may pass an edge on the other side: see agreement_test.cpp.
constexpr double kShareOfEdges = 0.001;

const Material kMatte{.color = {0.9, 0.6, 0.3}, .diffuse = 0.8};
const Material kMirror{.color = {0.4, 0.5, 0.6}, .diffuse = 0.4, .specular = 0.5};
const Material kGlass{.color = {1, 1, 1}, .diffuse = 0.1, .transmittance = 0.8, .refractive_index = 1.5};

// Returns a scene without objects: material 0 matte, 1 a mirror, 2 glass; two lights and a background.
SceneDescription stage(const Vec3d& from, const Vec3d& at, double angle, const Vec3d& up = {0, 1, 0}) {
  SceneDescription scene = scene_with(kMatte, {{30, 50, 70}, {-60, 10, 40}});
  scene.materials = {kMatte, kMirror, kGlass};
  scene.background = Rgb(0.1, 0.2, 0.4);
  scene.view = view_from(from, at, angle, kSize);
  scene.view->up = up;
  return scene;
}

using Objects = std::function<void(SceneDescription&)>;

struct Case {
  const char* name;
  SceneDescription scene;
  Objects add;
};

double share_wrong(Case c) {
  c.add(c.scene);
  return share_different(traced_picture(c.scene, kSize), oracle_picture(c.scene, kSize));
}

void check_all(const char* what, const std::vector<Case>& cases) {
  Worst worst;
  for (const Case& c : cases) {
    const double share = share_wrong(c);
    CAPTURE(c.name, share);
    CHECK(share <= kShareOfEdges);
    worst.add(share, c.name);
  }
  report(fmt::format("{}: {} pictures of {} x {} against long double", what, cases.size(), kSize, kSize),
         "0.1 % of pixels off by more than 1/255", "as above", worst.percent());
}

Objects sphere(const Vec3d& center, double radius, MaterialIndex material = 0) {
  return [=](SceneDescription& s) { add_sphere(s, {center, radius, material, {}}); };
}
Objects cone(const Vec3d& base, double r0, const Vec3d& apex, double r1, MaterialIndex material = 0) {
  return [=](SceneDescription& s) { add_cone(s, {base, r0, apex, r1, material, {}}); };
}
Objects all(std::vector<Objects> objects) {
  return [objects = std::move(objects)](SceneDescription& s) {
    for (const Objects& add : objects) add(s);
  };
}

}  // namespace

TEST_CASE("spheres that touch, nest or enclose the eye are rendered as the oracle renders them") {
  const SceneDescription front = stage({0, 1, 8}, {0, 0, 0}, 40);
  check_all("spheres that touch, nest and fill the view",
            {
                {"touching", front, all({sphere({-1, 0, 0}, 1), sphere({1, 0, 0}, 1, 1)})},
                {"touching glass", front, all({sphere({-1, 0, 0}, 1, 2), sphere({1, 0, 0}, 1, 2)})},
                {"touching from within", front, all({sphere({0, 0, 0}, 2, 2), sphere({1, 0, 0}, 1, 1)})},
                {"nested glass", front, all({sphere({0, 0, 0}, 2, 2), sphere({0, 0, 0}, 1, 2)})},
                {"the same twice", front, all({sphere({0, 0, 0}, 2), sphere({0, 0, 0}, 2)})},
                {"the eye within", stage({0.2, 0.1, 0.3}, {1, 0, 0}, 90),
                 all({sphere({0, 0, 0}, 1, 1), sphere({0.7, 0, 0}, 0.1)})},
                {"the eye in glass", stage({0.2, 0.1, 0.3}, {1, 0, 0}, 90),
                 all({sphere({0, 0, 0}, 1, 2), sphere({3, 0, 0}, 1)})},
                {"a rim that fills the view", stage({0, 0, 1.0000001}, {1, 0, 1}, 60), sphere({0, 0, 0}, 1)},
                {"a million radii away", stage({0, 0, 1e6}, {0, 0, 0}, 2e-4), sphere({0, 0, 0}, 1)},
            });
}

TEST_CASE("cylinders and cones at their limits are rendered as the oracle renders them") {
  const SceneDescription side = stage({0, 1, 8}, {0, 0, 0}, 40), above = stage({0, 0, 8}, {0, 0, 0}, 40);
  const double next = std::nextafter(1.0, 2.0);
  check_all(
      "cylinders and cones at their limits",
      {
          {"cylinder along its axis", above, cone({0, 0, -5}, 1, {0, 0, 5}, 1)},
          {"cylinder from within, along its axis", stage({0, 0, 4}, {0, 0, -9}, 90),
           cone({0, 0, -5}, 1, {0, 0, 5}, 1, 1)},
          {"cylinder from within, across", stage({0.3, 0, 0}, {1, 0.2, 0}, 90),
           cone({0, 0, -5}, 1, {0, 0, 5}, 1, 1)},
          {"cone from within", stage({0, 0, -1.5}, {0.5, 0, 2}, 80), cone({0, 0, -2}, 1, {0, 0, 2}, 0, 1)},
          {"cone onto its tip", above, cone({0, 0, -2}, 2, {0, 0, 2}, 0)},
          {"cone along its side", stage({2, 0, -2}, {0, 0, 2}, 30), cone({0, 0, -2}, 1.5, {0, 0, 2}, 0)},
          {"double tip", above, all({cone({0, 0, -2}, 2, {0, 0, 0}, 0), cone({0, 0, 2}, 1, {0, 0, 0}, 0)})},
          {"radii equal but for a bit", side, cone({-2, 0, 0}, 1, {2, 0, 0}, next, 1)},
          {"radii equal but for a bit, along", above, cone({0, 0, -5}, next, {0, 0, 5}, 1, 1)},
          {"radii almost equal", side, cone({-2, 0, 0}, 1, {2, 0, 0}, 1 + 1e-9, 1)},
          {"needles", side,
           all({cone({-2, 0, 0}, 4e-6, {2, 0.1, 0}, 0), cone({-2, 1, 0}, 4e-6, {2, 1, 0}, 4e-6)})},
          {"discs", side,
           all({cone({-1, 0, 0}, 1, {-1 + 1e-6, 0, 1e-6}, 0), cone({1, 0, 0}, 1, {1, 1e-6, 1e-6}, 0.2)})},
          {"glass tube", side,
           all({cone({-2, 0, 0}, 1, {2, 0, 0}, 1, 2), cone({-2, 0, 0}, 0.9, {2, 0, 0}, 0.9, 2)})},
          {"grazing", stage({-9, 1 + 1e-7, 0}, {0, 1, 0}, 10), cone({-5, 0, 0}, 1, {5, 0, 0}, 1)},
      });
}

TEST_CASE("polygons and patches at their limits are rendered as the oracle renders them") {
  const SceneDescription front = stage({0, 1, 8}, {0, 0, 0}, 40);
  const auto polygon = [](const std::vector<Vec3d>& corners, MaterialIndex material = 0) -> Objects {
    return [=](SceneDescription& s) { add_polygon(s, corners, material); };
  };
  const auto patch = [](const std::array<PatchVertex, 3>& corners, MaterialIndex material = 0) -> Objects {
    return [=](SceneDescription& s) { add_patch(s, corners, material); };
  };
  std::vector<Vec3d> comb;
  for (int i = 0; i < 20; ++i) {
    comb.emplace_back(-2 + 0.2 * i, -1, 0), comb.emplace_back(-2 + 0.2 * i, 1.5, 0);
    comb.emplace_back(-1.9 + 0.2 * i, 1.5, 0), comb.emplace_back(-1.9 + 0.2 * i, -0.9, 0);
  }
  comb.emplace_back(2.1, -0.9, 0), comb.emplace_back(2.1, -1, 0);
  const Vec3d a(-2, -1, 0), b(2, -1, 0.5), c(0, 2, 0), zero(0, 0, 0);
  const Vec3d n = (b - a).cross(c - a);
  check_all(
      "polygons and patches at their limits",
      {
          {"edge on", stage({0, 0, 8}, {0, 0, 0}, 40),
           polygon({{-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}})},
          {"grazed", stage({0, 1e-6, 8}, {0, 0, 0}, 40),
           polygon({{-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2}})},
          {"grazed mirror", stage({0, 0.01, 8}, {0, 0, 0}, 40),
           all({polygon({{-9, 0, -9}, {9, 0, -9}, {9, 0, 7}, {-9, 0, 7}}, 1), sphere({0, 1, 0}, 1)})},
          {"a comb", front, polygon(comb)},
          {"corners in a row", front,
           polygon({a, a * 0.5 + b * 0.5, b, b * 0.7 + c * 0.3, b * 0.2 + c * 0.8, c})},
          {"corners twice", front, polygon({a, a, b, c, c, c})},
          {"a spike back and forth", front, polygon({a, b, c, c * 2, c})},
          {"a sliver", front, polygon({a, b, b + Vec3d(0, 1e-7, 0)})},
          {"normals of no length", front, patch({{{a, zero}, {b, zero}, {c, zero}}})},
          {"one normal of no length", front, patch({{{a, zero}, {b, n}, {c, n}}}, 1)},
          {"normals opposed to the winding", front, patch({{{a, -n}, {b, -n}, {c, -n}}}, 1)},
          {"normals opposed to each other", front, patch({{{a, n}, {b, -n}, {c, n}}})},
          {"normals almost in the surface", front,
           patch({{{a, b - a + n * 0.01}, {b, c - b + n * 0.01}, {c, a - c + n * 0.01}}}, 1)},
          {"normals long and short", front, patch({{{a, n * 1e9}, {b, n * 1e-9}, {c, Vec3d(0, 1, 9)}}}, 1)},
          {"glass panes that touch", front,
           all({polygon({{-2, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-2, 2, 0}}, 2),
                polygon({{-1, -2, 0}, {3, -2, 0}, {3, 1, 0}, {-1, 1, 0}}, 2)})},
      });
}

TEST_CASE("a huge sphere seen from near is rendered as the oracle renders it") {
  const double r = 1e6;
  check_all("a sphere of radius 1e6 from near",
            {
                {"alone", stage({0, 2, 8}, {0, 0.5, 0}, 40), sphere({0, -r, 0}, r)},
                {"under a ball", stage({0, 2, 8}, {0, 0.5, 0}, 40),
                 all({sphere({0, -r, 0}, r), sphere({0, 1, 0}, 1, 1)})},
                {"above", stage({0, 2, 8}, {0, 0.5, 0}, 40),
                 all({sphere({0, r + 4, 0}, r, 1), sphere({0, 1, 0}, 1)})},
            });
}

}  // namespace pprt::hard_surfaces_test
