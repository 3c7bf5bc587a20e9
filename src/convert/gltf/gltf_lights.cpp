#include "convert/gltf/gltf_lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "convert/gltf/gltf_document.h"
#include "convert/model/display_values.h"
#include "scene/animation/resting_nodes.h"

namespace pprt {
namespace {

constexpr double kFar = 100;  // radii of the scene, from which the sun's rays are parallel within .6 degrees

// A light with its brightness in the middle of the scene, linear.
struct LightAtWork {
  Vec3d place{0, 0, 0};  // in its space
  std::array<double, 3> brightness{};
};

double brightest(const LightAtWork& light) {
  return *std::max_element(light.brightness.begin(), light.brightness.end());
}

LightAtWork at_work(const tinygltf::Light& from, const ModelSpace& space, const Affine& to_world,
                    const Box3d& box) {
  LightAtWork light;
  const Affine map = to_world * space.map;
  double intensity = std::max(from.intensity, 0.0);
  if (from.type == "directional") {
    const Vec3d back = space.map.vector({0, 0, 1}).normalized();
    const Vec3d to_middle = inverse(to_world).point(box.center());
    light.place = to_middle + back * (kFar * 0.5 * box.size().length());
  } else {
    light.place = space.map.origin;
    intensity /= std::max((map.origin - box.center()).length2(), least_distance2(box));
  }
  for (std::size_t i = 0; i < 3; ++i)
    light.brightness[i] = intensity * (i < from.color.size() ? std::max(from.color[i], 0.0) : 1.0);
  return light;
}

}  // namespace

void add_gltf_lights(const tinygltf::Model& model, const std::vector<PlacedGltfLight>& placed,
                     GltfLosses& losses, ModelBuilder& builder) {
  if (placed.empty() || builder.scene().primitive_count() == 0) return;
  const SceneDescription& scene = builder.scene();
  const double start = start_time(scene.movement);
  const std::vector<Placement> places = placements_at(scene.movement, start);
  Box3d box;
  for (std::size_t i = 0; i < scene.order.size(); ++i)
    box.extendBy(mapped(places[node_of(scene, i)].to_parent, bounds(scene, scene.order[i])));
  std::vector<LightAtWork> lights;
  double most = 0;
  for (const PlacedGltfLight& at : placed) {
    const tinygltf::Light& from = element(model.lights, at.light, "a light");
    if (from.type == "spot") losses.add(GltfLoss::kSpot);
    if (from.type != "directional") losses.add(GltfLoss::kDistance);
    lights.push_back(at_work(from, at.space, places[at.space.node].to_parent, box));
    most = std::max(most, brightest(lights.back()));
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double scale = most > 0 && std::isfinite(most) ? 1 / most : 0;
    Rgb color;
    for (int c = 0; c < 3; ++c)
      color[c] = display_value(lights[i].brightness[static_cast<std::size_t>(c)] * scale);
    const bool is_white = color == Rgb(1, 1, 1);
    // The space of a light whose place is given in it.
    builder.add_light(lights[i].place, is_white ? std::nullopt : std::optional<Rgb>(color),
                      {placed[i].space.node, {}});
  }
}

}  // namespace pprt
