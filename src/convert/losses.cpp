#include "convert/losses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include "scene/description/shading_rules.h"

namespace pprt {
namespace {

// Returns the materials that some object has.
std::vector<bool> used_materials(const SceneDescription& scene) {
  std::vector<bool> used(scene.materials.size(), false);
  for (const PrimitiveRef ref : scene.order) used[material_of(scene, ref)] = true;
  return used;
}

Rgb mean_color(const Texture& texture) {
  std::uint64_t sum[3] = {};
  for (std::size_t i = 0; i < texture.rgb.size(); ++i) sum[i % 3] += texture.rgb[i];
  const double all = 255.0 * static_cast<double>(std::max<std::size_t>(texture.rgb.size() / 3, 1));
  return {static_cast<double>(sum[0]) / all, static_cast<double>(sum[1]) / all,
          static_cast<double>(sum[2]) / all};
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

void drop_textures(PlainScene& plain, const std::vector<bool>& used) {
  SceneDescription& scene = plain.scene;
  std::vector<Rgb> means;
  for (const Texture& texture : scene.textures) means.push_back(mean_color(texture));
  std::set<TextureIndex> dropped;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    if (!m.texture) continue;
    if (used[i]) dropped.insert(*m.texture);
    const Rgb& mean = means[*m.texture];
    m.color *= mean;
    if (m.terms) m.terms->ambient *= mean, m.terms->diffuse *= mean;
    m.texture.reset();
  }
  if (dropped.empty()) return;
  plain.losses.push_back(counted(dropped.size(), "texture is not kept: its surfaces get its mean colour",
                                 "textures are not kept: their surfaces get their mean colours"));
}

void tell_highlights(PlainScene& plain, const std::vector<bool>& used) {
  std::size_t colored = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Material& m = plain.scene.materials[i];
    if (!used[i] || !m.terms) continue;
    const Rgb& s = m.terms->specular;
    colored += s.x != s.y || s.y != s.z;
  }
  if (colored == 0) return;
  plain.losses.push_back(counted(colored, "material with a coloured highlight and mirror: it becomes white",
                                 "materials with a coloured highlight and mirror: they become white"));
}

}  // namespace

PlainScene for_nff(SceneDescription scene) {
  PlainScene plain{std::move(scene), {}};
  const std::vector<bool> used = used_materials(plain.scene);
  drop_textures(plain, used);
  tell_highlights(plain, used);
  if (!plain.scene.ambient) return plain;
  plain.losses.emplace_back("the ambient light and its colours are not kept: NFF has none");
  if (plain.scene.lights.empty()) return plain;
  const double brighter = 1 / light_weight(plain.scene.lights.size());
  for (Light& light : plain.scene.lights) light.color = light.color.value_or(Rgb(1, 1, 1)) * brighter;
  plain.losses.push_back(
      fmt::format("the lights are made {:.2f} times as bright, as readers of NFF weaken them", brighter));
  return plain;
}

PlainScene for_meshes(SceneDescription scene, bool keeps_textures) {
  PlainScene plain{std::move(scene), {}};
  if (!keeps_textures) drop_textures(plain, used_materials(plain.scene));
  if (plain.scene.ambient) plain.losses.emplace_back("the ambient light is not kept");
  return plain;
}

}  // namespace pprt
