// Rays that leave a surface must not find it again. No point of these scenes can shade another, whatever the
// lights. A picture with shadows must therefore equal one without, ray by ray.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "numeric/report.h"
#include "unit/trace/test_scenes.h"

namespace pprt::leaving_rays_test {

using namespace pprt::test;

namespace {

constexpr int kLights = 25;
constexpr int kSize = 100;

// Adds lights in all directions; many of them graze any surface.
void add_lights(SceneDescription& scene, double distance) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < kLights; ++i) {
    const Vec3d direction = Vec3d(normal(engine), normal(engine), normal(engine)).normalized();
    scene.lights.push_back({direction * distance, {}, {}});
  }
}

// Shadow rays that met their own surface, for the report.
int returned = 0;

void report_leaving(const std::string& what, std::uint64_t rays) {
  report(fmt::format("{} rays leave {}", rays, what), "none finds it again", "offsets above",
         returned == 0 ? "none" : fmt::format("{} pixels", returned));
  returned = 0;
}

// Requires that no shadow ray is stopped. Returns the number of shadow rays.
std::uint64_t check_no_shadow(SceneDescription scene, const View& view, double light_distance = 50) {
  scene.lights.clear();
  add_lights(scene, light_distance);
  CompileOptions without;
  without.effects = parse_effects("smooth-normals");
  const CompiledScene shadowed = compile(scene), plain = compile(scene, without);
  View large = view;
  large.width = large.height = kSize;
  Tracer a(shadowed, shadowed.camera(large)), b(plain, plain.camera(large));
  int differing = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const RaySample with = a.trace(x + 0.5, y + 0.5), sans = b.trace(x + 0.5, y + 0.5);
      differing += with.color != sans.color;
    }
  }
  CHECK(differing == 0);
  returned += differing;
  return a.counts().shadow;
}

// Checks pictures from all around the scene until enough rays have left it.
std::uint64_t check_around(const SceneDescription& scene, double distance) {
  std::uint64_t rays = 0;
  for (int i = 0; rays < static_cast<std::uint64_t>(trials(100'000)); ++i) {
    REQUIRE(i < trials(40));
    const Vec3d from(std::cos(i), std::sin(i), std::sin(2.3 * i));
    rays += check_no_shadow(scene, view_from(from.normalized() * distance, {0, 0, 0}, 25));
  }
  return rays;
}

SceneDescription matte() {
  return scene_with(Material());
}

}  // namespace

TEST_CASE("rays leave a sphere, whatever its size in the scene, and never meet it again") {
  std::uint64_t rays = 0;
  for (const double radius : {1.0, 0.01, 1e-4}) {
    SceneDescription scene = matte();
    add_sphere(scene, {{0, 0, 0}, radius, 0, {}});
    if (radius < 1) {  // something far off makes the scene large; it lies outside every ray's way
      add_sphere(scene, {{1000 * radius, 1000 * radius, 1000 * radius}, 1e-3 * radius, 0, {}});
    }
    CAPTURE(radius);
    rays += check_around(scene, 5 * radius);
  }
  report_leaving("a sphere, of a share of the scene down to 1e-7", rays);
}

TEST_CASE("rays leave the inside of a sphere and never meet it again") {
  SceneDescription scene = matte();
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  std::uint64_t rays = 0;
  for (int i = 0; i < trials(3); ++i) {
    const double turn = i % 10, height = 0.06 * (i % 15);
    rays +=
        check_no_shadow(scene, view_from({0.1, 0.2, height}, {std::cos(turn), std::sin(turn), 0}, 90), 0.9);
  }
  CHECK(rays > 100000);
  report_leaving("the inside of a sphere", rays);
}

TEST_CASE("rays leave cylinders and cones and never meet them again") {
  SceneDescription cylinder = matte();
  add_cone(cylinder, {{0, 0, -50}, 1, {0, 0, 50}, 1, 0, {}});
  SceneDescription cone = matte();
  add_cone(cone, {{0, 0, -2}, 1, {0, 0, 2}, 0, 0, {}});
  // Seen from its sides only: through the open ends the inside would be visible, which is in shadow.
  std::uint64_t all = 0;
  for (const SceneDescription& scene : {cylinder, cone}) {
    std::uint64_t rays = 0;
    for (int i = 0; i < trials(12); ++i) {
      rays += check_no_shadow(scene, view_from({6 * std::cos(i), 6 * std::sin(i), 0.5}, {0, 0, 0}, 18), 40);
    }
    CHECK(rays > 100000);
    all += rays;
  }
  report_leaving("a cylinder, and a cone", all);
}

TEST_CASE("rays leave polygons, slender and concave ones too, and never meet them again") {
  SceneDescription square = matte();
  add_square(square, 1, 0);
  std::uint64_t rays = check_around(square, 4);

  SceneDescription star = matte();
  std::vector<Vec3d> corners;
  for (int i = 0; i < 144; ++i) {
    const double radius = i % 4 < 2 ? 1 : 0.9;
    corners.emplace_back(radius * std::cos(i * std::numbers::pi / 72),
                         radius * std::sin(i * std::numbers::pi / 72), 0);
  }
  add_polygon(star, corners, 0);
  rays += check_around(star, 4);

  SceneDescription strip = matte();
  add_polygon(strip, std::vector<Vec3d>{{-1, -0.01, 0}, {1, -0.01, 0.3}, {1, 0.01, 0.3}, {-1, 0.01, 0}}, 0);
  std::uint64_t of_strip = 0;
  for (int i = 0; i < trials(30); ++i) {
    of_strip += check_no_shadow(strip, view_from({0, 3.0 * i / trials(30), 1}, {0, 0, 0.15}, 10));
  }
  CHECK(of_strip > 20000);
  report_leaving("polygons, slender and concave ones among them", rays + of_strip);
}

TEST_CASE("rays leave triangles of any shape in any plane and never meet them again") {
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> u(-1, 1);
  const auto point = [&] { return Vec3d(u(engine), u(engine), u(engine)); };
  std::uint64_t rays = 0;
  for (int i = 0; i < trials(20); ++i) {
    const Vec3d a = point(), b = point(), c = a + (b - a) * 0.4 + point() * (i % 2 ? 1 : 0.05);
    SceneDescription scene = matte();
    add_polygon(scene, std::vector<Vec3d>{a, b, c}, 0);
    const Vec3d middle = (a + b + c) * (1 / 3.0);
    View view = view_from(middle + (b - a).cross(c - a).normalized() * 3, middle, 40);
    view.up = b - a;
    rays += check_no_shadow(scene, view);
  }
  CHECK(rays > 100000);
  report_leaving("triangles of any shape in any plane", rays);
}

TEST_CASE("rays leave a patch and never meet it again") {
  SceneDescription scene = matte();
  // The normals are those of its plane. Others would light points that are in the patch's own shadow.
  const Vec3d a(-1, -1, 0), b(1, -1, 0.1), c(0.3, 1, 0);
  const Vec3d normal = (b - a).cross(c - a);
  const PatchVertex corners[] = {{a, normal}, {b, normal}, {c, normal}};
  add_patch(scene, corners, 0);
  report_leaving("a patch", check_around(scene, 4));
}

}  // namespace pprt::leaving_rays_test
