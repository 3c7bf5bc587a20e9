#include "trace/survey/effects.h"

#include <algorithm>
#include <array>

#include "base/diagnostics.h"
#include "base/nearest_word.h"
#include "scene/description/shading_rules.h"
#include "trace/survey/inventory.h"

namespace pprt {
namespace {

struct EffectName {
  Effect effect;
  std::string_view name;
};

constexpr std::array kNames = {
    EffectName{Effect::kShadows, "shadows"},
    EffectName{Effect::kHighlights, "highlights"},
    EffectName{Effect::kReflection, "reflection"},
    EffectName{Effect::kRefraction, "refraction"},
    EffectName{Effect::kSmoothNormals, "smooth-normals"},
    EffectName{Effect::kTextures, "textures"},
    EffectName{Effect::kEmission, "emission"},
    EffectName{Effect::kSky, "sky"},
};

std::vector<bool> materials_in_use(const SceneDescription& scene) {
  std::vector<bool> used(scene.materials.size(), false);
  for (const Sphere& s : scene.spheres) used[s.material] = true;
  for (const Cone& c : scene.cones) used[c.material] = true;
  for (const Polygon& p : scene.polygons) used[p.material] = true;
  for (const Patch& p : scene.patches) used[p.material] = true;
  for (const TriangleMesh& m : scene.meshes) used[m.material] = true;
  for (const MovingTriangle& t : scene.moving_triangles) used[t.material] = true;
  return used;
}

std::string_view trimmed(std::string_view word) {
  const auto first = word.find_first_not_of(" \t");
  if (first == word.npos) return {};
  return word.substr(first, word.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::string_view name(Effect effect) {
  return std::find_if(kNames.begin(), kNames.end(), [&](const EffectName& e) { return e.effect == effect; })
      ->name;
}

std::vector<Effect> every_effect() {
  std::vector<Effect> effects;
  effects.reserve(kNames.size());
  for (const EffectName& e : kNames) effects.push_back(e.effect);
  return effects;
}

EffectSet parse_effects(std::string_view list) {
  if (trimmed(list) == "none") return EffectSet();
  if (trimmed(list) == "all") return EffectSet::all();
  EffectSet effects;
  while (true) {
    const auto comma = list.find(',');
    const std::string_view word = trimmed(list.substr(0, comma));
    const auto found =
        std::find_if(kNames.begin(), kNames.end(), [&](const EffectName& e) { return e.name == word; });
    if (found == kNames.end()) {
      std::vector<std::string_view> words = {"auto", "all", "none"};
      for (const EffectName& e : kNames) words.push_back(e.name);
      throw UsageError("unknown effect '" + std::string(word) + "'; there are " +
                       to_string(EffectSet::all()) + ", and the words auto, all and none" +
                       did_you_mean(word, words));
    }
    effects.add(found->effect);
    if (comma == list.npos) return effects;
    list.remove_prefix(comma + 1);
  }
}

std::string to_string(EffectSet effects) {
  std::string list;
  for (const EffectName& e : kNames) {
    if (!effects.has(e.effect)) continue;
    if (!list.empty()) list += ',';
    list += e.name;
  }
  return list.empty() ? "none" : list;
}

Inventory take_inventory(const SceneDescription& scene) {
  Inventory inventory{.spheres = scene.spheres.size(),
                      .cones = scene.cones.size(),
                      .polygons = scene.polygons.size(),
                      .patches = scene.patches.size(),
                      .triangles = scene.triangles.size(),
                      .moving_triangles = scene.moving_triangles.size(),
                      .lights = scene.lights.size(),
                      .has_sky = scene.sky.has_value()};
  inventory.suns = static_cast<std::size_t>(
      std::count_if(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return l.is_sun; }));
  inventory.smooth_meshes = static_cast<std::size_t>(std::count_if(
      scene.meshes.begin(), scene.meshes.end(), [](const TriangleMesh& m) { return !m.normals.empty(); }));
  inventory.moving_nodes = static_cast<std::size_t>(
      std::count_if(scene.movement.nodes.begin(), scene.movement.nodes.end(),
                    [&](const SceneNode& node) { return scene.movement.tracks.contains(node.track); }));
  const std::vector<bool> used = materials_in_use(scene);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const Material& material = scene.materials[i];
    ++inventory.materials;
    if (material.specular > 0) ++inventory.reflecting;
    if (has_highlight(material)) ++inventory.highlighting;
    if (material.transmittance > 0) ++inventory.transmitting;
    if (material.has_picture()) ++inventory.textured;
    if (material.emission != Rgb(0, 0, 0)) ++inventory.emitting;
    if (std::max(material.specular, 0.0) + std::max(material.transmittance, 0.0) > 1) ++inventory.brightening;
  }
  return inventory;
}

EffectSet effects_called_for(const Inventory& inventory) {
  EffectSet effects;
  if (inventory.lights > 0) effects.add(Effect::kShadows);
  if (inventory.lights > 0 && inventory.highlighting > 0) effects.add(Effect::kHighlights);
  if (inventory.reflecting > 0) effects.add(Effect::kReflection);
  if (inventory.transmitting > 0) effects.add(Effect::kRefraction);
  if (inventory.patches + inventory.smooth_meshes + inventory.moving_triangles > 0)
    effects.add(Effect::kSmoothNormals);
  if (inventory.textured > 0) effects.add(Effect::kTextures);
  if (inventory.emitting > 0) effects.add(Effect::kEmission);
  if (inventory.has_sky) effects.add(Effect::kSky);
  return effects;
}

EffectSet effects_called_for(const SceneDescription& scene) {
  return effects_called_for(take_inventory(scene));
}

}  // namespace pprt
