#include <fmt/format.h>

#include "base/counted.h"
#include "trace/scene_impl.h"

namespace pprt {
namespace {

std::string primitives(const CompiledScene::Impl& scene) {
  const Inventory& held = scene.inventory;
  std::string text;
  const auto add = [&](std::size_t n, const char* singular, const char* plural) {
    if (n == 0) return;
    if (!text.empty()) text += ", ";
    text += counted(n, singular, plural);
  };
  add(held.spheres, "sphere", "spheres");
  add(held.cones, "cone or cylinder", "cones and cylinders");
  add(held.polygons, "polygon", "polygons");
  add(held.patches, "patch", "patches");
  add(held.triangles, "triangle", "triangles");
  add(held.moving_triangles, "triangle that changes its shape", "triangles that change their shape");
  if (scene.figures.triangles > 0 && held.polygons + held.patches > 0)
    text += fmt::format(" ({})", counted(scene.figures.triangles, "triangle", "triangles"));
  if (scene.figures.degenerate > 0)
    text += fmt::format("; {} without extent left out", scene.figures.degenerate);
  if (scene.figures.repeated > 0)
    text += fmt::format("; {} that repeat others left out", scene.figures.repeated);
  if (scene.figures.coincident > 0)
    text += fmt::format("; {} in one plane with others that they overlap",
                        counted(scene.figures.coincident, "triangle", "triangles"));
  return text;
}

// Returns why the scene calls for an effect, or does not.
std::string reason(Effect effect, const Inventory& held) {
  const auto materials = [](std::size_t n, const char* with) {
    return n == 0 ? fmt::format("no material {}", with)
                  : fmt::format("{} {}", counted(n, "material", "materials"), with);
  };
  switch (effect) {
    case Effect::kShadows:
      return held.lights == 0 ? "no light" : counted(held.lights, "light", "lights");
    case Effect::kHighlights:
      return held.lights == 0 ? "no light"
                              : materials(held.highlighting, "with Ks > 0 and a finite highlight");
    case Effect::kReflection:
      return materials(held.reflecting, "with Ks > 0");
    case Effect::kRefraction:
      return materials(held.transmitting, "with T > 0");
    case Effect::kSmoothNormals:
      if (held.patches > 0) return counted(held.patches, "patch", "patches");
      if (held.smooth_meshes > 0)
        return counted(held.smooth_meshes, "mesh with normals", "meshes with normals");
      return held.moving_triangles > 0
                 ? counted(held.moving_triangles, "triangle with normals", "triangles with normals")
             : held.triangles > 0 ? "no patch, and no mesh with normals"
                                  : "no patch";
    case Effect::kTextures:
      return materials(held.textured, "with a texture");
    case Effect::kEmission:
      return materials(held.emitting, held.emitting > 1 ? "that give off light" : "that gives off light");
    case Effect::kSky:
      return held.has_sky ? "the background is a sky" : "the background is of one colour";
  }
  return {};
}

std::string effect_line(Effect effect, const CompiledScene::Impl& scene) {
  const bool chosen = scene.effects.has(effect);
  std::string why = reason(effect, scene.inventory);
  if (!chosen && effects_called_for(scene.inventory).has(effect)) {
    const bool allowed = !scene.options.effects || scene.options.effects->has(effect);
    why += allowed ? ", but the depth ends with the eye ray" : ", but ruled out by the effects asked for";
  }
  return fmt::format("  {:<15} {:<3}  {}\n", name(effect), chosen ? "yes" : "no", why);
}

}  // namespace

std::string census_text(const CompiledScene::Impl& scene) {
  std::string text;
  text += fmt::format("scene       {}\n", scene.name);
  text += fmt::format("primitives  {}\n", primitives(scene));
  text += fmt::format("materials   {} in use", scene.inventory.materials);
  if (const std::size_t n = scene.inventory.brightening; n > 0) {
    text +=
        fmt::format("; {} with Ks + T above 1, brighter than what is seen in {}", n, n == 1 ? "it" : "them");
  }
  text += '\n';
  text += fmt::format("lights      {}", scene.inventory.lights);
  if (const std::size_t n = scene.inventory.suns; n > 0) text += ", of them " + counted(n, "sun", "suns");
  text += '\n';
  if (scene.moves) {
    const std::size_t n = scene.inventory.moving_nodes, t = scene.inventory.moving_triangles;
    text += fmt::format(
        "movement    {}{}\n", counted(n, "object that moves", "objects that move"),
        t > 0 ? fmt::format(", {} that change their shape", counted(t, "triangle", "triangles")) : "");
  }
  text += "effects\n";
  for (Effect effect : every_effect()) text += effect_line(effect, scene);
  text += fmt::format("simulated   {}{}\n", to_string(scene.effects),
                      scene.options.count_as_published ? "; rays are counted as published" : "");
  text += fmt::format("depth       {}\n", scene.options.max_depth);
  text += fmt::format("hierarchy   built in {:.1f} ms; {:.2f} MB, primitives {:.2f} MB\n",
                      1e3 * scene.figures.seconds, 1e-6 * static_cast<double>(scene.figures.hierarchy_bytes),
                      1e-6 * static_cast<double>(scene.figures.primitive_bytes));
  if (!scene.textures.empty()) {
    text += fmt::format("textures    {}; {:.2f} MB, smaller copies for the distance included\n",
                        counted(scene.textures.size(), "picture", "pictures"),
                        1e-6 * static_cast<double>(scene.figures.texture_bytes));
  }
  return text;
}

}  // namespace pprt
