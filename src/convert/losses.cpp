#include "convert/losses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include "base/counted.h"
#include "parser/text/text_input.h"
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

// Forgets a texture of some term of a material, for its mean.
void drop(std::optional<TextureIndex>& texture, const std::vector<Rgb>& means, bool is_used,
          std::set<TextureIndex>& dropped, const std::function<void(const Rgb&)>& tint) {
  if (!texture) return;
  if (is_used) dropped.insert(*texture);
  tint(means[*texture]);
  texture.reset();
}

void drop_textures(PlainScene& plain, const std::vector<bool>& used) {
  SceneDescription& scene = plain.scene;
  std::vector<Rgb> means;
  for (const Texture& texture : scene.textures) means.push_back(mean_color(texture));
  std::set<TextureIndex> dropped;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    drop(m.texture, means, used[i], dropped, [&](const Rgb& mean) {
      m.color *= mean;
      if (m.terms) m.terms->ambient *= mean, m.terms->diffuse *= mean;
    });
    drop(m.emission_texture, means, used[i], dropped, [&](const Rgb& mean) { m.emission *= mean; });
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

void drop_emission(PlainScene& plain, const std::vector<bool>& used) {
  std::size_t lamps = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    Material& m = plain.scene.materials[i];
    lamps += used[i] && m.emission != Rgb(0, 0, 0);
    m.emission = Rgb(0, 0, 0);
  }
  if (lamps == 0) return;
  plain.losses.push_back(counted(lamps, "material that gives off light: NFF has none, so it does not glow",
                                 "materials that give off light: NFF has none, so they do not glow"));
}

void drop_sky(PlainScene& plain) {
  if (!plain.scene.sky) return;
  plain.scene.background = ground_color(plain.scene);
  plain.scene.sky.reset();
  plain.losses.emplace_back("the sky is not kept: the background has the colour below its horizon");
}

// Puts suns where their rays are parallel within a hundredth of a degree.
void bring_suns_near(PlainScene& plain) {
  constexpr double kFar = 1e4;  // sizes of the scene
  SceneDescription& scene = plain.scene;
  const Box3d box = bounds(scene);
  const double distance = std::min(kFar * box.size().length(), 0.1 * kLargestNumber);
  std::size_t suns = 0;
  for (Light& light : scene.lights) {
    if (!light.is_sun) continue;
    light.position = box.center() + light.position.normalized() * distance;
    light.is_sun = false;
    ++suns;
  }
  if (suns == 0) return;
  plain.losses.push_back(counted(suns, "sun becomes a light far away", "suns become lights far away"));
}

}  // namespace

PlainScene for_nff(SceneDescription scene) {
  PlainScene plain{std::move(scene), {}};
  const std::vector<bool> used = used_materials(plain.scene);
  drop_textures(plain, used);
  tell_highlights(plain, used);
  drop_emission(plain, used);
  drop_sky(plain);
  bring_suns_near(plain);
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
