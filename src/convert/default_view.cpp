#include "convert/default_view.h"

#include <cmath>
#include <numbers>

#include "scene/description/view_frame.h"

namespace pprt {
namespace {

double bounding_radius(const SceneDescription& scene) {
  const Box3d box = bounds(scene);
  const double radius = 0.5 * (box.max - box.min).length();
  return radius > 0 ? radius : 1;
}

}  // namespace

View fitted_view(const SceneDescription& scene, UpAxis up) {
  View view;
  const double radius = bounding_radius(scene);
  view.angle_degrees = 45;
  view.up = up == UpAxis::kY ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  // Half to the right of the front and two fifths above it. The front faces +z with y up, or -y with z up.
  const Vec3d direction = up == UpAxis::kY ? Vec3d(0.5, 0.4, 1) : Vec3d(0.5, -1, 0.4);
  const double half_angle = 0.5 * view.angle_degrees * (std::numbers::pi / 180);
  const double distance = radius / std::sin(half_angle);
  view.at = bounds(scene).center();
  view.from = view.at + direction.normalized() * distance;
  view.hither = 0.001 * distance;
  return view;
}

Light default_light(const SceneDescription& scene, const View& view) {
  const ViewFrame frame = view_frame(view, scene.name);
  const double radius = bounding_radius(scene);
  return {view.from + (frame.up - frame.right) * radius, {}, {}};
}

}  // namespace pprt
