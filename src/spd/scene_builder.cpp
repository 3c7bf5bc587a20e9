#include "spd/scene_builder.h"

#include <cmath>

namespace pprt::spd {
namespace {

// Returns the exponent s with cos(angle)^s = 1/2. The bounds are SPD's: no highlight counts as a very small
// one.
double phong_exponent(double highlight_degrees) {
  if (highlight_degrees <= 0) return 100000;
  if (highlight_degrees >= 90) return 1;
  return std::log(0.5) / std::log(std::cos(radians(highlight_degrees)));
}

}  // namespace

Imath::M44d rotation(const Vec3d& axis, double angle) {
  Imath::M44d matrix;
  return matrix.setAxisAngle(axis, angle);
}

void SceneBuilder::view(const Vec3d& from, const Vec3d& at, const Vec3d& up, double hither) {
  scene.background = Rgb(0.078, 0.361, 0.753);
  scene.view.emplace();
  scene.view->from = from;
  scene.view->at = at;
  scene.view->up = up;
  scene.view->hither = hither;
}

void SceneBuilder::lights(std::initializer_list<Vec3d> positions) {
  for (const Vec3d& position : positions) scene.lights.push_back({position, {}, {}});
}

void SceneBuilder::fill(const Fill& fill) {
  current_ = materials_.intern(scene.materials, {.color = fill.color,
                                                 .diffuse = fill.diffuse,
                                                 .specular = fill.specular,
                                                 .shine = phong_exponent(fill.highlight_degrees),
                                                 .transmittance = fill.transmittance,
                                                 .refractive_index = fill.refractive_index});
}

void SceneBuilder::sphere(const Vec3d& center, double radius) {
  add_sphere(scene, {center, radius, current_, {}});
}

void SceneBuilder::cone(const Vec3d& base, double base_radius, const Vec3d& apex, double apex_radius) {
  add_cone(scene, {base, base_radius, apex, apex_radius, current_, {}});
}

void SceneBuilder::polygon(std::span<const Vec3d> vertices) {
  add_polygon(scene, vertices, current_);
}

void SceneBuilder::patch(std::span<const PatchVertex> vertices) {
  add_patch(scene, vertices, current_);
}

}  // namespace pprt::spd
