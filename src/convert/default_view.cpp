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

// Returns how far an object reaches along a direction of any length: the largest dot product.
double reach(const SceneDescription& scene, PrimitiveRef ref, const Vec3d& along) {
  double most = -std::numeric_limits<double>::infinity();
  const auto take = [&](const Vec3d& p) { most = std::max(most, p.dot(along)); };
  const auto take_disc = [&](const Vec3d& center, double radius, const Vec3d& unit_axis) {
    const double off_axis = std::max(along.length2() - std::pow(along.dot(unit_axis), 2), 0.0);
    most = std::max(most, center.dot(along) + radius * std::sqrt(off_axis));
  };
  switch (ref.kind) {
    case PrimitiveKind::kSphere: {
      const Sphere& s = scene.spheres[ref.index];
      take_disc(s.center, std::abs(s.radius), Vec3d(0, 0, 0));
      break;
    }
    case PrimitiveKind::kCone: {
      const Cone& c = scene.cones[ref.index];
      const Vec3d axis = (c.apex - c.base).normalized();
      take_disc(c.base, c.base_radius, axis);
      take_disc(c.apex, c.apex_radius, axis);
      break;
    }
    case PrimitiveKind::kPolygon:
      for (const Vec3d& v : scene.vertices(scene.polygons[ref.index])) take(v);
      break;
    case PrimitiveKind::kPatch:
      for (const PatchVertex& v : scene.vertices(scene.patches[ref.index])) take(v.position);
      break;
    case PrimitiveKind::kTriangle: {
      const Triangle& t = scene.triangles[ref.index];
      for (const std::uint32_t i : t.corners.position) take(scene.meshes[t.mesh].positions[i]);
      break;
    }
    case PrimitiveKind::kMovingTriangle:
      for (const MovingTriangle::Key& key : scene.moving_triangles[ref.index].keys) {
        for (const Vec3d& p : key.positions) take(p);
      }
      break;
  }
  return most;
}

// Moves a camera, whose direction stays, so that what it sees just fits between the margins. Tangents of half
// the picture's angle are `slope`.
Vec3d fitted_place(const SceneDescription& scene, const ViewFrame& frame, double slope) {
  const Vec3d middle = bounds(scene).center();
  // How far objects reach beyond planes of the slope through the middle: to the right, left, up and down.
  const Vec3d recede = frame.forward * slope;
  const std::array<Vec3d, 4> sides{frame.right - recede, -frame.right - recede, frame.up - recede,
                                   -frame.up - recede};
  std::array<double, 4> most{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    most[i] = -std::numeric_limits<double>::infinity();
    for (const PrimitiveRef ref : scene.order) most[i] = std::max(most[i], reach(scene, ref, sides[i]));
    most[i] -= middle.dot(sides[i]);
  }
  const double distance = std::max({most[0] + most[1], most[2] + most[3], 0.0}) / (2 * slope);
  return middle + frame.right * ((most[0] - most[1]) / 2) + frame.up * ((most[2] - most[3]) / 2) -
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
