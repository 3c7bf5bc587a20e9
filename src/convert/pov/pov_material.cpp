#include "convert/pov/pov_material.h"

#include <algorithm>

#include "convert/names/picture_names.h"
#include "scene/description/shading_rules.h"

namespace pprt {
namespace {

// Share of the diffuse colour that a channel gets which reflects ambient light only. A display shows none of
// it.
constexpr double kLeastPigment = 0x1p-20;

// Least share of a highlight that a channel gets.
constexpr double kLeastFilter = 0x1p-10;

double largest(const Rgb& c) {
  return std::max({c.x, c.y, c.z});
}

bool is_grey(const Rgb& c) {
  return c.x == c.y && c.y == c.z;
}

// Pigment, diffuse and ambient share from a colour for each term.
void set_terms(const Rgb& ambient, const Rgb& diffuse, bool textured, PovMaterial& result) {
  result.diffuse = largest(diffuse);
  result.ambient = ambient;
  if (!(result.diffuse > 0)) {
    result.diffuse = 0;
    return;
  }
  for (int c = 0; c < 3; ++c) {
    result.pigment[c] = diffuse[c] / result.diffuse;
    if (ambient[c] == 0) continue;
    result.lost_ambient = result.lost_ambient || (textured && !(result.pigment[c] > 0));
    result.pigment[c] = std::max(result.pigment[c], kLeastPigment);
    result.ambient[c] = ambient[c] / result.pigment[c];
  }
}

// A highlight is white in POV-Ray. A layer above colours it, and the surface gets more of what that takes.
// Not so where it would colour what lies behind the surface, or where a picture would need more than 8 bits.
void set_highlight(const SceneDescription& scene, const Material& m, const Rgb& specular,
                   PovMaterial& result) {
  if (is_grey(specular) || !m.terms) {
    result.phong = m.specular;
    return;
  }
  if (m.transmittance > 0 || m.texture) {
    result.lost_highlight = true;
    result.phong = (specular.x + specular.y + specular.z) / 3;
    return;
  }
  result.phong = largest(specular);
  Rgb filter;
  for (int c = 0; c < 3; ++c) filter[c] = std::max(specular[c] / result.phong, kLeastFilter);
  set_terms(m.terms->ambient * scene.ambient.value_or(Rgb(1, 1, 1)) / filter, m.terms->diffuse / filter,
            false, result);
  result.filter = filter;
}

}  // namespace

PovMaterial pov_material(const SceneDescription& scene, const Material& m) {
  PovMaterial result;
  const Rgb ambient_light = scene.ambient.value_or(Rgb(1, 1, 1));
  Rgb specular(m.specular, m.specular, m.specular);
  if (m.terms) {
    set_terms(m.terms->ambient * ambient_light, m.terms->diffuse, m.texture.has_value(), result);
    specular = m.terms->specular;
  } else {
    const double weight = scene.ambient ? 1 : light_weight(scene.lights.size());
    result.pigment = m.color;
    result.diffuse = m.diffuse;
    result.ambient = ambient_light * (kAmbientReflectance * weight);
  }
  // POV-Ray scales the ambient and the diffuse share by the pigment's opacity, NFF does not.
  result.transmit = std::clamp(m.transmittance, 0.0, kLargestTransmittance);
  const double per_opacity = 1 / (1 - result.transmit);
  result.ambient *= per_opacity;
  result.diffuse *= per_opacity;
  if (m.emission != Rgb(0, 0, 0)) result.emission = m.emission / (1 - kLargestTransmittance);
  if (m.specular > 0) result.reflection = specular;
  if (has_highlight(m)) set_highlight(scene, m, specular, result);
  return result;
}

PovPictures pov_pictures(const SceneDescription& scene, const std::string& stem) {
  PovPictures result;
  std::vector<PovPicture>& files = result.files;
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(files.begin(), files.end(), [&](const PovPicture& f) { return f.name == name; });
  };
  const auto file_of = [&](std::optional<TextureIndex> texture, const Rgb& tint) {
    std::optional<std::size_t> at;
    if (!texture) return at;
    const auto equal = std::find_if(files.begin(), files.end(), [&](const PovPicture& f) {
      return f.texture == *texture && f.tint == tint;
    });
    at = static_cast<std::size_t>(equal - files.begin());
    if (equal == files.end())
      files.push_back({picture_name(stem, scene.textures[*texture], is_taken), *texture, tint});
    return at;
  };
  for (const Material& m : scene.materials) {
    result.materials.push_back(file_of(m.texture, pov_material(scene, m).pigment));
    result.emissions.push_back(file_of(m.emission_texture, Rgb(1, 1, 1)));
  }
  return result;
}

Image picture_of(const SceneDescription& scene, const PovPicture& picture) {
  const Texture& texture = scene.textures[picture.texture];
  Image image(texture.width, texture.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double value = texture.rgb[3 * i + static_cast<std::size_t>(c)] / 255.0;
      image.pixels[i][c] = static_cast<float>(value * picture.tint[c]);
    }
  }
  return image;
}

}  // namespace pprt
