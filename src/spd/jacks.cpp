// "jacks": a three-armed cross with a smaller one in each octant, recursively.
#include <array>

#include "spd/generators.h"

namespace pprt::spd {
namespace {

struct JackMaker {
  SceneBuilder& out;
  const Imath::M44d to_world = rotation(kAxisY, radians(-20)) * rotation(kAxisX, radians(-30));

  void jack(const Vec3d& center, double scale, int levels) const {
    const double arm = 0.75 * scale;
    constexpr std::array<Vec3d, 3> kAxes = {kAxisX, kAxisY, kAxisZ};
    for (const Vec3d& axis : kAxes) {
      out.cylinder((center - axis * arm) * to_world, (center + axis * arm) * to_world, 0.1 * arm);
    }
    for (const double side : {arm, -arm}) {
      for (const Vec3d& axis : kAxes) out.sphere((center + axis * side) * to_world, 0.2 * arm);
    }
    if (levels == 1) return;
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        for (const double z : {-0.5, 0.5}) jack(center + Vec3d(x, y, z) * scale, scale / 2, levels - 1);
      }
    }
  }
};

}  // namespace

void build_jacks(SceneBuilder& out, int size) {
  out.view({0, 0, -8}, {0, 0, 0}, {0, 1, 0}, 0.001);
  out.scene.view->angle_degrees = 25;
  out.scene.view->width = out.scene.view->height = 256;
  out.scene.background = Rgb(0.2, 0.05, 0.2);
  out.lights({{-10, 3, -20}});
  out.fill({.color = {0.737, 0.561, 0.561},
            .diffuse = 0.7,
            .specular = 0.7,
            .highlight_degrees = 20,
            .refractive_index = 1});
  JackMaker{out}.jack({0, 0, 0}, 1, size);
}

}  // namespace pprt::spd
