#include "convert/default_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/description/shading_rules.h"
#include "scene/description/view_frame.h"

namespace pprt {
namespace {

constexpr double kMargin = 0.06;  // of the picture, on each side

double bounding_radius(const SceneDescription& scene) {
  const Box3d box = bounds(scene);
  const double radius = 0.5 * (box.max - box.min).length();
  return radius > 0 ? radius : 1;
}

// Calls `use` for the corners of each object's box.
template <typename Use>
void for_each_corner(const SceneDescription& scene, const Use& use) {
  for (const PrimitiveRef ref : scene.order) {
    const Box3d box = bounds(scene, ref);
    for (unsigned corner = 0; corner < 8; ++corner)
      use(Vec3d((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                (corner & 4) != 0 ? box.max.z : box.min.z));
  }
}

// Moves a camera, whose direction stays, so that what it sees just fits between the margins. Tangents of half
// the picture's angle are `slope`.
Vec3d fitted_place(const SceneDescription& scene, const ViewFrame& frame, double slope) {
  const Vec3d middle = bounds(scene).center();
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  // How far corners reach beyond planes of the slope through the middle: to the right, left, up and down.
  std::array<double, 4> reach{kNone, kNone, kNone, kNone};
  for_each_corner(scene, [&](const Vec3d& corner) {
    const Vec3d p = corner - middle;
    const double x = p.dot(frame.right), y = p.dot(frame.up), recede = slope * p.dot(frame.forward);
    reach = {std::max(reach[0], x - recede), std::max(reach[1], -x - recede), std::max(reach[2], y - recede),
             std::max(reach[3], -y - recede)};
  });
  const double distance = std::max({(reach[0] + reach[1]), (reach[2] + reach[3]), 0.0}) / (2 * slope);
  return middle + frame.right * ((reach[0] - reach[1]) / 2) + frame.up * ((reach[2] - reach[3]) / 2) -
         frame.forward * distance;
}

}  // namespace

View fitted_view(const SceneDescription& scene, UpAxis up) {
  View view;
  const double radius = bounding_radius(scene);
  view.angle_degrees = 45;
  view.up = up == UpAxis::kY ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
  // Half to the right of the front and two fifths above it. The front faces +z with y up, or -y with z up.
  const Vec3d direction = up == UpAxis::kY ? Vec3d(0.5, 0.4, 1) : Vec3d(0.5, -1, 0.4);
  view.at = bounds(scene).center();
  view.from = view.at + direction.normalized() * radius;
  const ViewFrame frame = view_frame(view, scene.name);
  const double slope = std::tan(0.5 * view.angle_degrees * (std::numbers::pi / 180)) * (1 - 2 * kMargin);
  view.from = fitted_place(scene, frame, slope);
  const double distance = std::max((bounds(scene).center() - view.from).dot(frame.forward), 1e-3 * radius);
  view.at = view.from + frame.forward * distance;
  view.hither = 0.001 * distance;
  return view;
}

std::vector<Light> default_lights(const SceneDescription& scene, const View& view) {
  constexpr double kFill = 0.3;       // of the key light
  constexpr double kIndoors = 0.1;    // of the scene's radius
  constexpr double kAside = 0.75;     // of the distance, both to the left and up
  constexpr double kFillAside = 0.9;  // to the right
  const ViewFrame frame = view_frame(view, scene.name);
  const Box3d box = bounds(scene);
  const double reach = box.intersects(view.from) ? kIndoors * bounding_radius(scene)
                                                 : std::max((view.from - box.center()).length(), 1e-9);
  // Lights count as written where there is ambient light, otherwise by NFF's rule for two.
  const double brightness = scene.ambient ? 1 : 1 / light_weight(2);
  const auto light = [&](const Vec3d& place, double intensity) {
    const double v = intensity * brightness;
    return Light{place, v == 1 ? std::nullopt : std::optional<Rgb>(Rgb(v, v, v)), {}};
  };
  return {light(view.from + (frame.up - frame.right) * (kAside * reach), 1),
          light(view.from + frame.right * (kFillAside * reach), kFill)};
}

}  // namespace pprt
