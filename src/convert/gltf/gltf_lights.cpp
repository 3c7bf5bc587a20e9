#include "convert/gltf/gltf_lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "convert/gltf/gltf_document.h"
#include "convert/model/display_values.h"
#include "scene/animation/resting_nodes.h"

namespace pprt {
namespace {

// A light with its brightness in the middle of the scene, linear.
struct LightAtWork {
  Light light;  // in its space, without a colour
  std::array<double, 3> brightness{};
};

double brightest(const LightAtWork& light) {
  return *std::max_element(light.brightness.begin(), light.brightness.end());
}

LightAtWork at_work(const tinygltf::Light& from, const ModelSpace& space, const Affine& to_world,
                    const Box3d& box) {
  LightAtWork result;
  double intensity = std::max(from.intensity, 0.0);
  if (from.type == "directional") {
    result.light = {.position = {0, 0, 1}, .is_sun = true};
  } else {
    const Vec3d place = (to_world * space.map).origin;
    intensity /= std::max((place - box.center()).length2(), least_distance2(box));
  }
  for (std::size_t i = 0; i < 3; ++i)
    result.brightness[i] = intensity * (i < from.color.size() ? std::max(from.color[i], 0.0) : 1.0);
  return result;
}

}  // namespace

void add_gltf_lights(const tinygltf::Model& model, const std::vector<PlacedGltfLight>& placed,
                     ModelLosses& losses, ModelBuilder& builder) {
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
    if (from.type == "spot") losses.add(ModelLoss::kSpot);
    if (from.type != "directional") losses.add(ModelLoss::kDistance);
    lights.push_back(at_work(from, at.space, places[at.space.node].to_parent, box));
    most = std::max(most, brightest(lights.back()));
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double scale = most > 0 && std::isfinite(most) ? 1 / most : 0;
    Rgb color;
    for (int c = 0; c < 3; ++c)
      color[c] = display_value(lights[i].brightness[static_cast<std::size_t>(c)] * scale);
    if (color != Rgb(1, 1, 1)) lights[i].light.color = color;
    builder.add(lights[i].light, placed[i].space);
  }
}

}  // namespace pprt
