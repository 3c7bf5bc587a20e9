// Lights in, on and just beside surfaces.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "trace/geometry/numerics.h"
#include "unit/trace/test_scenes.h"

namespace pprt::light_contacts_test {

using namespace pprt::test;

namespace {

// Turns a point about an axis askew, so that no plane or light keeps round coordinates.
Vec3d askew(const Vec3d& p) {
  const Vec3d axis = Vec3d(0.3, -0.8, 0.5).normalized();
  constexpr double kAngle = 0.7;
  return p * std::cos(kAngle) + axis.cross(p) * std::sin(kAngle) +
         axis * (axis.dot(p) * (1 - std::cos(kAngle)));
}

// The last of a room's six polygons.
constexpr std::uint32_t kCeiling = 6;

// A closed room [-1, 1]^3 with one light; the ceiling is at z = 1. All of it is turned.
SceneDescription room(const Vec3d& light) {
  SceneDescription scene = scene_with(Material(), {askew(light)});
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      std::array<Vec3d, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) {
        const double u = i == 1 || i == 2 ? 1 : -1, v = i >= 2 ? 1 : -1;
        corners[i] = askew(axis == 0 ? Vec3d(side, u, v) : axis == 1 ? Vec3d(u, side, v) : Vec3d(u, v, side));
      }
      add_polygon(scene, corners, 0);
    }
  }
  return scene;
}

// The shares of image points, in a view all round from an eye, that direct light reaches. Points of the
// ceiling's own plane do not count.
double share_lit(const SceneDescription& scene, const Vec3d& eye) {
  constexpr int kSize = 64;
  const CompiledScene compiled = compile(scene);
  const double ambient = 0.1 * 0.5;
  int lit = 0, seen = 0;
  for (const Vec3d& way :
       {Vec3d(1, 0, 0), Vec3d(-1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, -1, 0), Vec3d(0, 0, -1)}) {
    View view = view_from(eye, eye + askew(way), 90, kSize);
    view.up = askew(Vec3d(0.1, 0.2, 1).cross(way).normalized());
    Tracer tracer(compiled, compiled.camera(view));
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const RaySample sample = tracer.trace(x + 0.5, y + 0.5);
        if (sample.primitive == kCeiling) continue;
        ++seen;
        lit += sample.color.x > 1.0001 * ambient;
      }
    }
  }
  return static_cast<double>(lit) / seen;
}

}  // namespace

TEST_CASE("a lamp in the plane of a ceiling lights the whole room, at every scale") {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const Vec3d& lamp : {Vec3d(0, 0, 1), Vec3d(0.3, -0.6, 1), Vec3d(0.5, 0.5, 1), Vec3d(0.99, 0.1, 1)}) {
      CAPTURE(scale, lamp.x, lamp.y);
      const SceneDescription scene = moved(room(lamp), {0.1, 0.2, 0.3}, scale);
      // The upper wall's points that see the lamp at less than a 256th above the ceiling may miss it.
      CHECK(share_lit(scene, (askew({0.2, 0.1, 0}) + Vec3d(0.1, 0.2, 0.3)) * scale) > 0.999);
    }
  }
}

TEST_CASE("a lamp just below a ceiling lights the room, one just above it does not") {
  for (const double beside : {1e-2, 1e-4, 1e-5}) {
    CAPTURE(beside);
    CHECK(share_lit(room({0.3, -0.6, 1 - beside}), askew({0.2, 0.1, 0})) > 0.9999);
    CHECK(share_lit(room({0.3, -0.6, 1 + beside}), askew({0.2, 0.1, 0})) == 0);
  }
}

TEST_CASE("a lamp in a corner of a room and on its edges lights what it faces") {
  // The walls that meet at the lamp lie in planes with it: two of five are dark at an edge, three at a
  // corner.
  CHECK(share_lit(room({1, 0.3, 1}), askew({0, 0, 0})) > 0.5);
  CHECK(share_lit(room({1, 1, 1}), askew({0, 0, 0})) > 0.3);
}

TEST_CASE("a lamp on a ball or a pipe is hidden by it only from behind") {
  const auto lit = [](const SceneDescription& scene, const Vec3d& eye, const Vec3d& at) {
    return look(compile(scene), view_from(eye, at)).color.x > 1.0001 * 0.05;
  };
  for (const double radius : {0.5, 1e-2, 1e-4}) {
    CAPTURE(radius);
    for (const bool pipe : {false, true}) {
      CAPTURE(pipe);
      const Vec3d top = askew({0, 0, radius});
      SceneDescription scene = scene_with(Material(), {top});
      if (pipe) {
        add_cone(scene, {askew({-1, 0, 0}), radius, askew({1, 0, 0}), radius, 0, {}});
      } else {
        add_sphere(scene, {{0, 0, 0}, radius, 0, {}});
      }
      for (const double z : {-3.0, 3.0}) {
        const std::array<Vec3d, 4> plate = {askew({-4, -4, z}), askew({4, -4, z}), askew({4, 4, z}),
                                            askew({-4, 4, z})};
        add_polygon(scene, plate, 0);
      }
      for (int i = 0; i < 400; ++i) {
        const double x = -3 + 0.3 * (i % 20), y = -3 + 0.3 * (i / 20) + 0.1;
        CAPTURE(x, y);
        CHECK(lit(scene, askew({0.2, -2, 2.5}), askew({x, y, 3})));
        // Below, the lamp stands over the horizon of the ball beyond a tangent that meets no plate of this
        // size.
        const bool in_shadow = !lit(scene, askew({0.2, -2, -2.5}), askew({x, y, -3}));
        CHECK(in_shadow);
      }
    }
  }
}

TEST_CASE("what lies beyond a lamp on a surface's rim casts no shadow") {
  // Half of the rays to the lamp pass the rim by rounding and go on to the screen behind.
  for (const bool on_ball : {false, true}) {
    CAPTURE(on_ball);
    const Vec3d lamp = askew({0.3, -0.1, 1});
    SceneDescription scene = scene_with(Material(), {lamp});
    if (on_ball) {
      add_sphere(scene, {askew({0.3, -0.1, 1.01}), 0.01, 0, {}});
    } else {
      const std::array<Vec3d, 3> shelf = {lamp, askew({2, -0.5, 1.4}), askew({2, 0.9, 1.4})};
      add_polygon(scene, shelf, 0);
    }
    for (const double x : {-4.0, 4.0}) {
      const std::array<Vec3d, 4> wall = {askew({x, -4, -4}), askew({x, 4, -4}), askew({x, 4, 4}),
                                         askew({x, -4, 4})};
      add_polygon(scene, wall, 0);
    }
    const CompiledScene compiled = compile(scene);
    for (int i = 0; i < 400; ++i) {
      const double y = -1 + 0.1 * (i % 20), z = -1 + 0.1 * (i / 20);
      CAPTURE(y, z);
      CHECK(look(compiled, view_from(askew({-1, y, z}), askew({-4, y, z}))).color.x > 1.0001 * 0.05);
    }
  }
}

// From behind, a ray crosses the ball 2 k r before the lamp, with k the cosine to the normal. It is hidden
// where that is more than the lamp's reach.
TEST_CASE(
    "a lamp on a ball is hidden from where the ball is crossed before its reach, and from nowhere else") {
  constexpr double kFar = 2;
  for (const double radius : {0.5, 1e-2}) {
    CAPTURE(radius);
    const Vec3d top(0, 0, radius);
    SceneDescription scene = scene_with(Material(), {askew(top)});
    add_sphere(scene, {{0, 0, 0}, radius, 0, {}});
    const std::array<Vec3d, 4> wall = {askew({kFar, -2, -2}), askew({kFar, -2, 2}), askew({kFar, 2, 2}),
                                       askew({kFar, 2, -2})};
    add_polygon(scene, wall, 0);
    const CompiledScene compiled = compile(scene);
    const auto place = [&](const Vec3d& p) { return compiled.camera(view_from(askew(p), {9, 9, 9})).eye; };
    const double scale = (place({1, 0, 0}) - place({0, 0, 0})).length();
    const double error = shadow_end_error((place({kFar, 0, 0}) - place(top)).length());
    // Where rounding moves a crossing as far as the other one is away: error / k = 2 k r.
    const double least = std::sqrt(error / (2 * radius * scale));
    const auto is_lit = [&](double cosine) {
      const Vec3d at(kFar, 0, radius + kFar * cosine);
      return look(compiled, view_from(askew({kFar - 1, 0.1, radius + 0.5}), askew(at))).color.x >
             1.0001 * 0.05;
    };
    for (int i = 0; i < 50; ++i) {
      const double k = least * (1.5 + 0.1 * i);
      CAPTURE(k / least);
      CHECK(is_lit(k));
      CHECK_FALSE(is_lit(-k));
    }
  }
}

}  // namespace pprt::light_contacts_test
