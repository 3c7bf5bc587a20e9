#include "scene/writers/nff_writer.h"

#include <catch2/catch.hpp>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <string>

namespace pprt::nff_writer_test {

namespace {

std::string nff(const SceneDescription& scene, NumberFormat format = NumberFormat::kShortest) {
  std::ostringstream out;
  write_nff(scene, out, format);
  return out.str();
}

// Two materials, the second of glass.
SceneDescription two_materials() {
  SceneDescription scene;
  scene.materials = {{}, {Rgb(0.5, 0.25, 1), 0.1, 0.2, 30, 0.9, 1.5}};
  return scene;
}

}  // namespace

TEST_CASE("an empty scene is an empty file") {
  CHECK(nff({}).empty());
}

TEST_CASE("what a scene does not give is not written") {
  SceneDescription scene = two_materials();
  add_sphere(scene, {{0, 0, 0}, 1, 1, {}});
  CHECK(nff(scene) == "f 0.5 0.25 1 0.1 0.2 30 0.9 1.5\ns 0 0 0 1\n");
}

TEST_CASE("a scene with every entity is written in SPD's layout") {
  SceneDescription scene = two_materials();
  scene.background = Rgb(0.078, 0.361, 0.753);
  scene.view = View{{4.5, 0.4, 2}, {0, 0, 1.5}, {0, 0, 1}, 45, 0.01, 640, 480, {}};
  scene.lights = {{{-5, 5, 50}, {}, {}}, {{1, 2, 3}, Rgb(1, 0.5, 0), {}}};
  const Vec3d polygon[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}};
  const PatchVertex patch[] = {{{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, -1, 0}}, {{0, 1, 0}, {0.5, 0, 0}}};
  add_polygon(scene, polygon, 0);
  add_cone(scene, {{1, 2, 3}, 0.5, {4, 5, 6}, 0.25, 0, {}});
  add_sphere(scene, {{7, 8, 9}, -2, 1, {}});
  add_patch(scene, patch, 1);
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  CHECK(nff(scene) == R"(b 0.078 0.361 0.753
v
from 4.5 0.4 2
at 0 0 1.5
up 0 0 1
angle 45
hither 0.01
resolution 640 480
l -5 5 50
l 1 2 3 1 0.5 0
f 1 1 1 1 0 0 0 1
p 3
0 0 0
1 0 0
0 1 0.5
c 1 2 3 0.5 4 5 6 0.25
f 0.5 0.25 1 0.1 0.2 30 0.9 1.5
s 7 8 9 -2
pp 3
0 0 0 0 0 1
1 0 0 0 -1 0
0 1 0 0.5 0 0
f 1 1 1 1 0 0 0 1
s 0 0 0 1
)");
}

TEST_CASE("every number reads back as itself") {
  const double values[] = {1.0 / 3,
                           -2.0 / 3,
                           1e300,
                           -0.0,
                           std::nextafter(1.0, 2.0),
                           std::numeric_limits<double>::denorm_min(),
                           -std::numeric_limits<double>::min(),
                           std::numeric_limits<double>::max()};
  for (const double value : values) {
    SceneDescription scene = two_materials();
    add_sphere(scene, {{value, 0, 0}, 1, 0, {}});
    const std::string text = nff(scene);
    const std::size_t at = text.find("\ns ") + 3;
    double read = 0;
    std::from_chars(text.data() + at, text.data() + text.size(), read);
    CHECK(read == value);
    CHECK(std::signbit(read) == std::signbit(value));
  }
}

TEST_CASE("numbers of six digits are written as by printf's %g") {
  for (const double value : {1.0 / 3, 100000.0, 1234567.0, 1.11022e-16, -0.0, 0.5, 2.5e-5, 999999.5}) {
    SceneDescription scene = two_materials();
    add_sphere(scene, {{0, 0, 0}, value, 0, {}});
    char expected[40];
    std::snprintf(expected, sizeof expected, "\ns 0 0 0 %g\n", value);
    CHECK(nff(scene, NumberFormat::kSixDigits).find(expected) != std::string::npos);
  }
}

TEST_CASE("nothing is lost where the buffer is emptied") {
  SceneDescription scene = two_materials();
  constexpr int kSpheres = 20000;  // about half a megabyte
  std::string expected = "f 1 1 1 1 0 0 0 1\n";
  for (int i = 0; i < kSpheres; ++i) {
    add_sphere(scene, {{i + 0.125, -i - 0.5, 0}, 1, 0, {}});
    expected += "s " + std::to_string(i) + ".125 -" + std::to_string(i) + ".5 0 1\n";
  }
  CHECK((nff(scene) == expected));
}

TEST_CASE("a stream that fails is left failed") {
  SceneDescription scene = two_materials();
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  std::ostringstream out;
  out.setstate(std::ios::badbit);
  write_nff(scene, out);
  CHECK(out.bad());
  CHECK(out.str().empty());
}

}  // namespace pprt::nff_writer_test
