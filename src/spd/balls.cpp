// "balls": the sphereflake, nine spheres on each sphere.
#include <algorithm>
#include <array>
#include <cmath>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

using Directions = std::array<Vec3d, 9>;

// Returns unit directions to the nine children of a sphere that grew along +z: three directions, each turned
// by thirds of a circle.
Directions child_directions() {
  const double d = std::numbers::sqrt2 / 2;
  const Imath::M44d tilt = rotation({1, -1, 0}, std::asin(2 / std::sqrt(6.0)));
  const std::array<Vec3d, 3> first = {Vec3d(d, d, 0) * tilt, Vec3d(d, 0, -d) * tilt, Vec3d(0, d, -d) * tilt};
  Directions all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t third = i / 3;
    all[i] = first[i % 3] * rotation(kAxisZ, radians(120.0 * static_cast<double>(third)));
  }
  return all;
}

// Rotates +z to the unit vector `direction`. SPD's bound decides when it is close to the axis: there the
// rotation axis would be zero, and any will do.
Imath::M44d rotation_from_z(const Vec3d& direction) {
  if (direction.z >= 0.9999) return {};
  if (direction.z <= -0.9999) return rotation(kAxisY, std::numbers::pi);
  return rotation(kAxisZ.cross(direction), std::acos(direction.z));
}

struct FlakeMaker {
  SceneBuilder& out;
  const Directions children = child_directions();

  void ball(const Vec3d& center, double radius, const Vec3d& direction, int depth) const {
    out.sphere(center, radius);
    if (depth == 0) return;
    const double distance = radius + radius / 3;
    const Imath::M44d turn = rotation_from_z(direction);
    for (const Vec3d& child : children) {
      const Vec3d child_direction = child * turn;
      ball(center + child_direction * distance, radius / 3, child_direction, depth - 1);
    }
  }
};

}  // namespace

void build_balls(SceneBuilder& out, int size) {
  out.view({2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, 0.01);
  out.lights({{4, 3, 2}, {1, -4, 4}, {-3, 1, 5}});
  out.fill({.color = {1, 0.75, 0.33}, .diffuse = 0.8, .refractive_index = 1});
  out.polygon({{12, 12, -0.5}, {-12, 12, -0.5}, {-12, -12, -0.5}, {12, -12, -0.5}});
  out.fill({.color = {1, 0.9, 0.7},
            .diffuse = 0.5,
            .specular = 0.5,
            .highlight_degrees = 37,
            .refractive_index = 1});
  FlakeMaker{out}.ball({0, 0, 0}, 0.5, kAxisZ, size);
}

}  // namespace pprt::spd
