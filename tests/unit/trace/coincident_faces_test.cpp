// Faces that lie in one another: what is seen of them does not depend on rounding.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "unit/trace/test_scenes.h"

namespace pprt::coincident_faces_test {

using namespace pprt::test;

namespace {

constexpr int kSize = 64;
constexpr MaterialIndex kRed = 0, kBlue = 1, kGlass = 2;

// Turns a point about an axis askew, so that no coordinate is exact in float.
Vec3d askew(const Vec3d& p) {
  const Vec3d axis = Vec3d(0.3, -0.8, 0.5).normalized();
  constexpr double kAngle = 0.7;
  return p * std::cos(kAngle) + axis.cross(p) * std::sin(kAngle) +
         axis * (axis.dot(p) * (1 - std::cos(kAngle)));
}

SceneDescription empty_scene() {
  SceneDescription scene = scene_with({.color = {1, 0, 0}, .diffuse = 1}, {askew({3, 2, 6})});
  scene.materials.push_back({.color = {0, 0, 1}, .diffuse = 1});
  scene.materials.push_back({.color = {0, 1, 0}, .diffuse = 0, .transmittance = 0.5, .refractive_index = 1});
  return scene;
}

struct Rectangle {
  double left, bottom, right, top;
  MaterialIndex material;
  double height = 0;
};

void add(SceneDescription& scene, const Rectangle& r) {
  add_polygon(scene,
              std::array{askew({r.left, r.bottom, r.height}), askew({r.right, r.bottom, r.height}),
                         askew({r.right, r.top, r.height}), askew({r.left, r.top, r.height})},
              r.material);
}

SceneDescription scene_of(const std::vector<Rectangle>& rectangles) {
  SceneDescription scene = empty_scene();
  for (const Rectangle& r : rectangles) add(scene, r);
  return scene;
}

// What rays from an eye above the plane see, row by row.
std::vector<RaySample> picture(const SceneDescription& scene) {
  const CompiledScene compiled = compile(scene);
  Tracer tracer(compiled, compiled.camera(view_from(askew({0.3, -3, 4}), askew({0, 0, 0}), 40, kSize)));
  std::vector<RaySample> samples;
  for (int i = 0; i < kSize * kSize; ++i)
    samples.push_back(tracer.trace(i % kSize + 0.5, static_cast<double>(i / kSize) + 0.5));
  return samples;
}

bool close(const Color& a, const Color& b) {
  const Color d = a - b;
  return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < 1e-4;
}

struct Seen {
  int front = 0, behind = 0, neither = 0;
};

// Counts whose colour `all` shows where `front` alone is seen, and where only `behind` is.
Seen compare(const std::vector<RaySample>& all, const std::vector<RaySample>& front,
             const std::vector<RaySample>& behind) {
  Seen seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_front = !front[i].at_infinity;
    const bool is_right = close(all[i].color, (is_front ? front : behind)[i].color);
    ++(!is_right ? seen.neither : is_front ? seen.front : seen.behind);
  }
  return seen;
}

constexpr Rectangle kFirst = {-1, -1, 1, 1, kRed};
constexpr Rectangle kSecond = {-0.7, -0.5, 1.3, 1.2, kBlue};

}  // namespace

TEST_CASE("coincident faces: the one earlier in the file is seen") {
  for (const auto& [first, second] : {std::pair(kFirst, kSecond), std::pair(kSecond, kFirst)}) {
    const Seen seen =
        compare(picture(scene_of({first, second})), picture(scene_of({first})), picture(scene_of({second})));
    CHECK(seen.front > 500);
    CHECK(seen.neither == 0);
  }
}

TEST_CASE("coincident faces: the one earlier in the file is seen however many there are") {
  std::vector<Rectangle> all;
  for (int i = 0; i < 300; ++i)
    all.push_back({-1 + 1e-4 * i, -1 - 2e-4 * i, 1 + 1e-4 * i, 1 - 1e-4 * i, i == 0 ? kRed : kBlue});
  const Seen seen =
      compare(picture(scene_of(all)), picture(scene_of({all[0]})), picture(scene_of({all[299]})));
  CHECK(seen.front > 500);
}

TEST_CASE("coincident faces: the nearer one is seen where their vertices tell it") {
  Rectangle above = kSecond;
  for (const double height : {8e-7, 1e-6, 2e-6, 1e-5}) {
    above.height = height;
    const Seen seen =
        compare(picture(scene_of({kFirst, above})), picture(scene_of({above})), picture(scene_of({kFirst})));
    CHECK(seen.front > 500);
    CHECK(seen.neither == 0);
  }
}

TEST_CASE("coincident faces: a glass does not hide what it stands on") {
  Rectangle glass = kFirst;
  glass.material = kGlass;
  const Seen seen =
      compare(picture(scene_of({glass, kSecond})), picture(scene_of({kSecond})), picture(scene_of({glass})));
  CHECK(seen.front > 500);
  CHECK(seen.neither == 0);
}

TEST_CASE("coincident faces: moving bodies have them, too") {
  std::string turn = "rot 4";
  for (int i = 0; i < 4; ++i)
    turn += " " + std::to_string(i) + " .3 -.8 .5 " + std::to_string(20 * i) + " 0 0 0";
  const auto with = [&](const std::string& faces) {
    return without_resting_nodes(
        parse_aff("v from .3 -3 4 at 0 0 0 up 0 1 0 angle 40 hither .1 resolution 64 64\n"
                  "am 1 1 1 b 0 0 0 l 3 2 6 1 1 1\n"
                  "fm .1 0 0 .8 0 0 0 0 0 0 0 1 s 9 9 -9 .1\n"
                  "a 1 2 9 x body {" +
                      faces + "} k body { " + turn + " }",
                  "c.aff")
            .scene);
  };
  const std::string red = "fm .1 0 0 .8 0 0 0 0 0 0 0 1 p 4 -1 -1 .01 1 -1 .01 1 1 .01 -1 1 .01\n";
  const std::string blue =
      "fm 0 0 .1 0 0 .8 0 0 0 0 0 1 p 4 -.7 -.5 .01 1.3 -.5 .01 1.3 1.2 .01 -.7 1.2 .01\n";
  const SceneDescription both = with(red + blue), one = with(red);
  const CompiledScene compiled_both = compile(both), compiled_one = compile(one);
  Tracer a(compiled_both, compiled_both.camera(*both.view)), b(compiled_one, compiled_one.camera(*one.view));
  a.set_time(1.4), b.set_time(1.4);
  int seen = 0, wrong = 0;
  for (int i = 0; i < kSize * kSize; ++i) {
    const double x = i % kSize + 0.5, y = static_cast<double>(i / kSize) + 0.5;
    const RaySample alone = b.trace(x, y);
    if (alone.at_infinity) continue;
    ++seen;
    wrong += !close(a.trace(x, y).color, alone.color);
  }
  CHECK(seen > 500);
  CHECK(wrong == 0);
}

TEST_CASE(
    "coincident faces: neighbours in a plane are none, nor are faces at an angle or one behind another") {
  SceneDescription scene = empty_scene();
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k)
      add(scene, {0.05 * i, 0.05 * k, 0.05 * (i + 1), 0.05 * (k + 1), kRed, k < 20 ? 0.0 : 1e-3});
  }
  add(scene, {0, 0, 2, 1, kBlue, 2e-5});
  add_polygon(scene, std::array{askew({0, 0, -1}), askew({1, 0, 1}), askew({0, 1, 1})}, kBlue);
  CHECK(compile(scene).census().find("overlap") == std::string::npos);
  add(scene, {0.01, 0.01, 0.04, 0.04, kBlue});
  CHECK(compile(scene).census().find("; 4 triangles in one plane with others that they overlap\n") !=
        std::string::npos);
}

TEST_CASE("coincident faces: twenty thousand in one place are found in time") {
  SceneDescription scene = empty_scene();
  for (int i = 0; i < 10000; ++i) add(scene, {-1 - 1e-6 * i, -1, 1, 1 + 1e-6 * i, kRed});
  CHECK(compile(scene).census().find("; 20000 triangles in one plane") != std::string::npos);
}

}  // namespace pprt::coincident_faces_test
