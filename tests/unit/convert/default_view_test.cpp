#include "convert/default_view.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "convert/model/display_values.h"
#include "scene/description/shading_rules.h"
#include "scene/description/view_frame.h"
#include "spd/spd.h"

namespace pprt::default_view_test {

TEST_CASE("a fitted view shows every corner of the scene, upright") {
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    const SceneDescription scene = make_spd("rings", 2);
    const View view = fitted_view(scene, up);
    const ViewFrame frame = view_frame(view, "rings");
    CHECK(frame.up[up == UpAxis::kY ? 1 : 2] > 0.8);
    CHECK(frame.right[up == UpAxis::kY ? 1 : 2] == Approx(0).margin(1e-12));
    for (const PrimitiveRef ref : scene.order) {
      const Box3d box = bounds(scene, ref);
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                      corner & 4 ? box.max.z : box.min.z);
        const Vec3d seen = p - view.from;
        const double depth = seen.dot(frame.forward);
        REQUIRE(depth > view.hither);
        REQUIRE(std::abs(seen.dot(frame.right)) < depth * frame.slope_per_pixel * view.width / 2);
        REQUIRE(std::abs(seen.dot(frame.up)) < depth * frame.slope_per_pixel * view.height / 2);
      }
    }
  }
}

// Slopes of the outermost points, in half pictures: right, left, up, down.
std::array<double, 4> reach(const std::vector<Vec3d>& points, const View& view) {
  const ViewFrame frame = view_frame(view, "");
  const double half = frame.slope_per_pixel * view.width / 2;
  std::array<double, 4> most{-9, -9, -9, -9};
  for (const Vec3d& p : points) {
    const Vec3d seen = p - view.from;
    const double x = seen.dot(frame.right) / seen.dot(frame.forward) / half;
    const double y = seen.dot(frame.up) / seen.dot(frame.forward) / half;
    most = {std::max(most[0], x), std::max(most[1], -x), std::max(most[2], y), std::max(most[3], -y)};
  }
  return most;
}

// Points of a disc's edge.
void add_disc(std::vector<Vec3d>& points, const Vec3d& center, const Vec3d& across, const Vec3d& other) {
  for (int i = 0; i < 360; ++i)
    points.push_back(center + across * std::cos(i * 0.0174533) + other * std::sin(i * 0.0174533));
}

void check_margins(const SceneDescription& scene, const std::vector<Vec3d>& points) {
  const std::array<double, 4> most = reach(points, fitted_view(scene, UpAxis::kY));
  CAPTURE(most[0], most[1], most[2], most[3]);
  const double across = std::max(most[0], most[1]), upright = std::max(most[2], most[3]);
  CHECK(std::max(across, upright) == Approx(0.88).margin(0.01));  // 6 % of the picture on each side
  // Both sides that decide are alike.
  CHECK((across > upright ? most[0] - most[1] : most[2] - most[3]) == Approx(0).margin(2e-3));
}

TEST_CASE("a fitted view has even margins, whatever is seen and however large") {
  for (const Vec3d& size :
       {Vec3d(1, 1, 1), Vec3d(0.01, 0.01, 0.01), Vec3d(1000, 1, 1), Vec3d(1, 9, 1), Vec3d(2, 0, 5)}) {
    CAPTURE(size.x, size.y, size.z);
    const Vec3d at = size * 3.0;
    const std::vector<Vec3d> corners{at, at + Vec3d(size.x, 0, 0), at + size, at + Vec3d(0, size.y, size.z)};
    SceneDescription polygon, patch, mesh, moving;
    for (SceneDescription* scene : {&polygon, &patch, &mesh, &moving}) scene->materials = {{}};
    add_polygon(polygon, corners, 0);
    check_margins(polygon, corners);
    std::vector<PatchVertex> vertices;
    for (const Vec3d& p : corners) vertices.push_back({p, {0, 0, 1}});
    add_patch(patch, vertices, 0);
    check_margins(patch, corners);
    const std::vector<Vec3d> three(corners.begin(), corners.begin() + 3);
    TriangleMesh triangles;
    triangles.positions = three;
    add_mesh(mesh, triangles, std::vector<TriangleCorners>{{.position = {0, 1, 2}}});
    check_margins(mesh, three);
    MovingTriangle triangle;
    triangle.keys = {{0, {corners[0], corners[1], corners[2]}, {}},
                     {1, {corners[1], corners[2], corners[3]}, {}}};
    add_moving_triangle(moving, triangle);
    check_margins(moving, corners);
  }
}

TEST_CASE("a fitted view has even margins about what is round") {
  SceneDescription ball, cone;
  ball.materials = cone.materials = {{}};
  add_sphere(ball, {{3, 1, 2}, 2, 0, {}});
  std::vector<Vec3d> points;
  for (int i = -80; i <= 80; ++i) {
    const double height = 2 * std::sin(i * 0.0196), radius = 2 * std::cos(i * 0.0196);
    add_disc(points, {3, 1 + height, 2}, {radius, 0, 0}, {0, 0, radius});
  }
  check_margins(ball, points);
  points.clear();
  const Vec3d across = Vec3d(2, -1, 0).normalized(), other = across.cross(Vec3d(1, 2, 0).normalized());
  add_cone(cone, {{0, 0, 0}, 3, {4, 8, 0}, 0.5, 0, {}});
  add_disc(points, {0, 0, 0}, across * 3.0, other * 3.0);
  add_disc(points, {4, 8, 0}, across * 0.5, other * 0.5);
  check_margins(cone, points);
}

TEST_CASE("default lights are left of the eye and above it, and to the right") {
  SceneDescription scene = make_spd("rings", 2);
  const View view = fitted_view(scene, UpAxis::kY);
  const ViewFrame frame = view_frame(view, "rings");
  const std::vector<Light> lights = default_lights(scene, view);
  REQUIRE(lights.size() == 2);
  CHECK((lights[0].position - view.from).dot(frame.right) < 0);
  CHECK((lights[0].position - view.from).dot(frame.up) > 0);
  CHECK((lights[1].position - view.from).dot(frame.right) > 0);
  // As bright as written, whichever rule holds.
  CHECK(lights[0].color.value().x * light_weight(2) == Approx(1));
  scene.ambient = Rgb(1, 1, 1);
  CHECK_FALSE(default_lights(scene, view)[0].color);
  CHECK(default_lights(scene, view)[1].color.value().x ==
        Approx(lights[1].color.value().x * light_weight(2)));
}

TEST_CASE("a grey ball in the default light spans most of the range of display values") {
  SceneDescription scene;
  scene.ambient = Rgb(1, 1, 1);
  scene.materials = {{}};
  add_sphere(scene, {{3, 2, 1}, 0.5, 0, {}});
  const View view = fitted_view(scene, UpAxis::kY);
  const std::vector<Light> lights = default_lights(scene, view);
  const double grey = display_value(0.5);
  double least = 1, most = 0;
  for (int i = 0; i < 64; ++i) {
    for (int k = 0; k < 128; ++k) {
      const double polar = (i + 0.5) * M_PI / 64, around = k * M_PI / 64;
      const Vec3d normal(std::sin(polar) * std::cos(around), std::cos(polar),
                         std::sin(polar) * std::sin(around));
      const Vec3d place = Vec3d(3, 2, 1) + normal * 0.5;
      if (normal.dot(view.from - place) <= 0) continue;  // not seen
      double shown = kAmbientReflectance;
      for (const Light& light : lights) {
        const double cosine = normal.dot((light.position - place).normalized());
        shown += std::max(cosine, 0.0) * light.color.value_or(Rgb(1, 1, 1)).x;
      }
      least = std::min(least, shown * grey), most = std::max(most, shown * grey);
    }
  }
  CHECK(least < 0.15);
  CHECK(most > 0.8);
  CHECK(most <= 1);
}

TEST_CASE("a fitted view looks from half right of the front, a bit above it, at the scene's depth") {
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
    SceneDescription scene;
    scene.materials = {{}};
    add_sphere(scene, {{3, 2, 1}, 0.5, 0, {}});
    const View view = fitted_view(scene, up);
    const ViewFrame frame = view_frame(view, "ball");
    const Vec3d expected = up == UpAxis::kY ? Vec3d(0.5, 0.4, 1) : Vec3d(0.5, -1, 0.4);
    CHECK((frame.forward + expected.normalized()).length() < 1e-9);
    CHECK(view.angle_degrees == 45);
    const Vec3d middle(3, 2, 1);
    CHECK((middle - view.at).dot(frame.forward) == Approx(0).margin(1e-9));
    CHECK(view.hither == Approx(0.001 * (view.at - view.from).length()));
  }
}

TEST_CASE("default lights are a key light and a weaker one, as far away as the eye is, or near it indoors") {
  SceneDescription scene;
  scene.ambient = Rgb(1, 1, 1);
  scene.materials = {{}};
  add_sphere(scene, {{0, 0, 0}, 2, 0, {}});
  View view;
  view.from = {0, 0, 10}, view.at = {0, 0, 0};
  for (const bool is_indoors : {false, true}) {
    if (is_indoors) view.from = {0, 0, 1};
    const double reach = is_indoors ? 0.1 * 2 * std::sqrt(3.0) : 10;
    const std::vector<Light> lights = default_lights(scene, view);
    REQUIRE(lights.size() == 2);
    const ViewFrame frame = view_frame(view, "ball");
    const Vec3d key = lights[0].position - view.from, fill = lights[1].position - view.from;
    CHECK(key.dot(frame.right) == Approx(-0.75 * reach));
    CHECK(key.dot(frame.up) == Approx(0.75 * reach));
    CHECK(key.dot(frame.forward) == Approx(0).margin(1e-9));
    CHECK((fill - frame.right * (0.9 * reach)).length() < 1e-9);
    CHECK((!lights[0].color && lights[1].color == Rgb(0.3, 0.3, 0.3)));
  }
}

}  // namespace pprt::default_view_test
