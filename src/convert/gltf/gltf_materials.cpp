#include "convert/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <utility>

#include "convert/model/display_values.h"
#include "image/atomic_file.h"
#include "image/image_io.h"
#include "scene/description/shading_rules.h"

namespace pprt {
namespace {

constexpr const char* kTransmission = "KHR_materials_transmission";
constexpr double kUsualIndex = 1.5;     // of refraction, by the specification
constexpr double kMirrored = 0.04;      // of the light, by what is no metal, by the specification
constexpr double kSmoothest = 0.05;     // roughness: a highlight of some degrees
constexpr double kClear = 0.1;          // roughness: glass up to it looks clear
constexpr double kMatte = 0.56;         // roughness: a highlight on what is no metal is a tenth of the light
constexpr double kLargestPicture = 64;  // tiles of a picture that continues beyond its border

double share(double v) {
  return std::isfinite(v) ? std::clamp(v, 0.0, 1.0) : 0;
}

Rgb display_color(const std::array<double, 3>& light) {
  return {display_value(light[0]), display_value(light[1]), display_value(light[2])};
}

std::array<double, 3> times(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}

std::array<double, 3> first_three(const std::vector<double>& values, double otherwise) {
  std::array<double, 3> result{otherwise, otherwise, otherwise};
  for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 3); ++i) result[i] = share(values[i]);
  return result;
}

bool is_grey(const std::array<double, 3>& color) {
  return color[0] == color[1] && color[1] == color[2];
}

std::vector<double> list_in(const tinygltf::Value& from, const char* member) {
  std::vector<double> values;
  if (!from.Has(member) || !from.Get(member).IsArray()) return values;
  for (std::size_t i = 0; i < from.Get(member).ArrayLen(); ++i) {
    const tinygltf::Value& value = from.Get(member).Get(static_cast<int>(i));
    values.push_back(value.IsNumber() ? value.GetNumberAsDouble() : 0);
  }
  return values;
}

// Whether light is mirrored at the surface of what is no metal.
bool is_glossy(const tinygltf::Material& from) {
  return number_in(from.extensions, "KHR_materials_specular", "specularFactor", 1) > 0 &&
         number_in(from.extensions, "KHR_materials_ior", "ior", kUsualIndex) != 1;
}

// Returns the index of refraction within what lets light through. Glass bends light where it encloses a
// volume; without a thickness it is a thin wall (KHR_materials_volume).
double index_within(const tinygltf::Material& from, bool is_glass) {
  const bool is_thick = number_in(from.extensions, "KHR_materials_volume", "thicknessFactor", 0) > 0;
  return is_glass && is_thick ? number_in(from.extensions, "KHR_materials_ior", "ior", kUsualIndex) : 1;
}

GltfPicture picture_of(int texture, int coordinates, const tinygltf::ExtensionMap& extensions) {
  constexpr const char* kTransform = "KHR_texture_transform";
  GltfPicture picture{.texture = texture, .coordinates = coordinates};
  const auto found = extensions.find(kTransform);
  if (found == extensions.end()) return picture;
  const std::vector<double> offset = list_in(found->second, "offset"),
                            scale = list_in(found->second, "scale");
  if (offset.size() == 2) picture.offset = Vec2d(offset[0], offset[1]);
  if (scale.size() == 2) picture.scale = Vec2d(scale[0], scale[1]);
  picture.turn = number_in(extensions, kTransform, "rotation", 0);
  picture.coordinates =
      static_cast<int>(number_in(extensions, kTransform, "texCoord", static_cast<double>(coordinates)));
  return picture;
}

// An older way to say it: a colour, and a highlight that is no metal's.
void take_glossiness(const tinygltf::Value& from, tinygltf::PbrMetallicRoughness& to) {
  const std::vector<double> factor = list_in(from, "diffuseFactor");
  if (factor.size() == 4) to.baseColorFactor = factor;
  to.metallicFactor = 0;
  const double glossiness =
      from.Has("glossinessFactor") ? from.Get("glossinessFactor").GetNumberAsDouble() : 1;
  to.roughnessFactor = 1 - share(glossiness);
  if (!from.Has("diffuseTexture")) return;
  const tinygltf::Value& texture = from.Get("diffuseTexture");
  if (texture.Has("index") && texture.Get("index").IsInt())
    to.baseColorTexture.index = texture.Get("index").GetNumberAsInt();
  if (texture.Has("texCoord") && texture.Get("texCoord").IsInt())
    to.baseColorTexture.texCoord = texture.Get("texCoord").GetNumberAsInt();
}

// Where a picture shows what, with tiles of its own size around it.
int texel_at(int place, int size, int mode) {
  const auto wrapped = [&](int period) { return ((place % period) + period) % period; };
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return std::clamp(place, 0, size - 1);
  if (mode != TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return wrapped(size);
  const int at = wrapped(2 * size);
  return at < size ? at : 2 * size - 1 - at;
}

// Returns a picture with its surroundings, from `low` on, both in tiles of its own size.
TransparentImage continued(const TransparentImage& whole, const tinygltf::Sampler& sampler, const Vec2d& low,
                           const Vec2d& tiles, std::uint64_t max_memory) {
  const Image& colors = whole.colors;
  const int columns = static_cast<int>(tiles.x) * colors.width,
            rows = static_cast<int>(tiles.y) * colors.height;
  if (sizeof(Color) * static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) > max_memory)
    throw std::runtime_error("it takes too much memory beyond its border");
  TransparentImage result{Image(columns, rows), {}};
  const int left = static_cast<int>(low.x) * colors.width, top = static_cast<int>(low.y) * colors.height;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const int column = texel_at(left + x, colors.width, sampler.wrapS);
      const int row = texel_at(top + y, colors.height, sampler.wrapT);
      result.colors.at(x, y) = colors.at(column, row);
      if (!whole.alpha.empty())
        result.alpha.push_back(
            whole.alpha[static_cast<std::size_t>(row) * static_cast<std::size_t>(colors.width) +
                        static_cast<std::size_t>(column)]);
    }
  }
  return result;
}

}  // namespace

const GltfSurface& GltfMaterials::surface(int material) {
  if (material < 0) {
    if (default_) return *default_;
    default_ = read(tinygltf::Material());
    default_->is_double_sided = true;  // who names no material has chosen no side
    return *default_;
  }
  element(model_.materials, material, "a material");
  std::optional<GltfSurface>& known = known_[static_cast<std::size_t>(material)];
  if (!known) known = read(model_.materials[static_cast<std::size_t>(material)]);
  return *known;
}

Material GltfMaterials::recoloured(const GltfSurface& surface, const std::array<double, 3>& factor) {
  Material material = surface.material;
  const Rgb before = display_color(surface.base), after = display_color(times(surface.base, factor));
  for (int i = 0; i < 3; ++i) {
    const double ratio = before[i] > 0 ? after[i] / before[i] : 0;
    material.color[i] *= ratio;
    if (material.terms) material.terms->diffuse[i] *= ratio, material.terms->ambient[i] *= ratio;
  }
  return material;
}

GltfSurface GltfMaterials::read(const tinygltf::Material& from) {
  GltfSurface surface;
  tinygltf::PbrMetallicRoughness pbr = from.pbrMetallicRoughness;
  if (const auto old = from.extensions.find("KHR_materials_pbrSpecularGlossiness");
      old != from.extensions.end())
    take_glossiness(old->second, pbr);
  surface.base = first_three(pbr.baseColorFactor, 1);
  surface.picture =
      picture_of(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions);
  surface.is_coloured = surface.picture.texture >= 0;

  // Which part of the light is mirrored, let through, or reflected to all sides.
  double metal = share(pbr.metallicFactor), rough = share(pbr.roughnessFactor);
  if (pbr.metallicRoughnessTexture.index >= 0) {
    const std::array<double, 4> picture = mean(pbr.metallicRoughnessTexture.index);
    rough *= picture[1], metal *= picture[2];
    losses_.add(ModelLoss::kRoughnessPicture);
  }
  double alpha = pbr.baseColorFactor.size() == 4 ? share(pbr.baseColorFactor[3]) : 1;
  const bool is_blended = from.alphaMode == "BLEND", is_masked = from.alphaMode == "MASK";
  if (is_masked && !surface.is_coloured) surface.is_hidden = alpha < from.alphaCutoff;
  if (is_masked && surface.is_coloured) surface.cutoff = alpha > 0 ? from.alphaCutoff / alpha : 2;
  if (is_blended && surface.is_coloured) {
    const double seen = mean(surface.picture.texture)[3];
    if (seen < 1) losses_.add(ModelLoss::kAlphaPicture);
    alpha *= seen;
  }
  surface.is_double_sided = from.doubleSided;
  const double let_through = read_glass(from, metal, rough);
  Material& m = surface.material;
  m.specular = metal * (1 - rough);
  m.transmittance = is_blended ? std::max(1 - alpha, let_through) : let_through;
  m.refractive_index = m.transmittance > 0 ? index_within(from, let_through > 0) : 1;
  if (m.specular > 0 && rough > 0)
    m.shine = 2 / std::pow(std::max(rough, kSmoothest), 4) - 2;  // Blinn's exponent of that roughness
  const bool is_unlit = from.extensions.contains("KHR_materials_unlit");
  if (metal < kMirrored && rough < kMatte && let_through == 0 && !is_unlit && is_glossy(from))
    losses_.add(ModelLoss::kHighlight);
  const auto volume = from.extensions.find("KHR_materials_volume");
  const bool is_tinted = volume != from.extensions.end() && volume->second.Has("attenuationColor");
  if (is_tinted || ((m.specular > 0 || let_through > 0) && !is_grey(surface.base)))
    losses_.add(ModelLoss::kTint);
  m.color = display_color(surface.base) * ((1 - m.specular) * (1 - m.transmittance));

  if (m.refractive_index != 1)  // what is reflected totally within it is seen
    m.terms = {.ambient = m.color * kAmbientReflectance,
               .diffuse = m.color,
               .specular = {m.specular, m.specular, m.specular}};

  if (from.normalTexture.index >= 0) losses_.add(ModelLoss::kNormalMap);
  if (from.occlusionTexture.index >= 0) losses_.add(ModelLoss::kOcclusion);
  set_glow(from, surface);
  return surface;
}

// Returns which share of the light is let through.
double GltfMaterials::read_glass(const tinygltf::Material& from, double metal, double rough) {
  const double let_through =
      share(number_in(from.extensions, kTransmission, "transmissionFactor", 0)) * (1 - metal);
  if (let_through == 0) return 0;
  if (from.extensions.at(kTransmission).Has("transmissionTexture")) losses_.add(ModelLoss::kGlassPicture);
  if (rough > kClear) losses_.add(ModelLoss::kFrosted);
  return let_through;
}

// What is unlit shows by ambient light: the scene's is 1, and each material says what it reflects of it.
void GltfMaterials::set_glow(const tinygltf::Material& from, GltfSurface& surface) {
  Material& m = surface.material;
  if (from.extensions.contains("KHR_materials_unlit")) {
    m = Material{.color = display_color(surface.base),
                 .transmittance = m.transmittance,
                 .refractive_index = m.refractive_index};
    m.terms = {.ambient = m.color, .diffuse = Rgb(0, 0, 0)};
    return;
  }
  std::array<double, 3> glow = first_three(from.emissiveFactor, 0);
  const double strength =
      number_in(from.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1);
  if (glow == std::array<double, 3>{0, 0, 0}) return;
  for (double& v : glow) v *= std::isfinite(strength) ? std::max(strength, 0.0) : 1;
  if (from.emissiveTexture.index >= 0) {
    const GltfPicture picture = picture_of(from.emissiveTexture.index, from.emissiveTexture.texCoord,
                                           from.emissiveTexture.extensions);
    if (!surface.is_coloured) surface.picture = picture;
    if (surface.picture.is_placed_as(picture)) {
      surface.emission_texture = picture.texture;
    } else {
      const std::array<double, 4> color = mean(picture.texture);
      for (std::size_t i = 0; i < 3; ++i) glow[i] *= light_of(color[i]);
      losses_.add(ModelLoss::kGlowPicture);
    }
  }
  for (int i = 0; i < 3; ++i) m.emission[i] = unbounded_display_value(glow[static_cast<std::size_t>(i)]);
}

void GltfMaterials::put_on(const GltfSurface& surface, Material& material, ModelMesh& mesh) {
  const GltfPicture& picture = surface.picture;
  const double cosine = std::cos(picture.turn), sine = std::sin(picture.turn);
  Vec2d low(0, 0), high(1, 1);
  for (Vec2d& place : mesh.texture_points) {
    const Vec2d scaled = place * picture.scale;
    place = Vec2d(cosine * scaled.x + sine * scaled.y, cosine * scaled.y - sine * scaled.x) + picture.offset;
    if (!is_in_range(place.x) || !is_in_range(place.y)) place = Vec2d(0, 0);
    for (int i = 0; i < 2; ++i) low[i] = std::min(low[i], place[i]), high[i] = std::max(high[i], place[i]);
  }
  const tinygltf::Texture& texture = element(model_.textures, picture.texture, "a texture");
  tinygltf::Sampler sampler;
  if (texture.sampler >= 0) sampler = element(model_.samplers, texture.sampler, "a sampler");
  Vec2d tiles(1, 1);
  const int modes[] = {sampler.wrapS, sampler.wrapT};
  constexpr double kBorder = 1e-3;  // of a picture: rounding
  for (int i = 0; i < 2; ++i) {
    const bool is_clamped = modes[i] == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    low[i] = std::floor(low[i] + kBorder), high[i] = std::ceil(high[i] - kBorder);
    tiles[i] = is_clamped ? high[i] - low[i] : modes[i] == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? 2 : 1;
    if (!is_clamped) low[i] = 0;
  }
  if (tiles.x * tiles.y > kLargestPicture) {
    losses_.add(ModelLoss::kBorder);
    low = Vec2d(0, 0), tiles = Vec2d(1, 1);
  }
  if (surface.is_coloured) material.texture = tiled(picture.texture, low, tiles);
  if (surface.emission_texture >= 0) material.emission_texture = tiled(surface.emission_texture, low, tiles);
  if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST && material.has_picture())
    losses_.add(ModelLoss::kHardTexels);
  for (Vec2d& place : mesh.texture_points) place = (place - low) / tiles;
}

std::optional<TextureIndex> GltfMaterials::tiled(int texture, const Vec2d& low, const Vec2d& tiles) {
  const tinygltf::Texture& from = element(model_.textures, texture, "a texture");
  const int image = from.source;
  if (image < 0) {
    builder_.notes().push_back("a texture without a picture that can be read is left out");
    return std::nullopt;
  }
  const tinygltf::Image& named = element(model_.images, image, "a picture");
  std::string key = !named.uri.empty()    ? named.uri
                    : !named.name.empty() ? named.name
                                          : "texture" + std::to_string(image);
  const std::string name = std::filesystem::path(key).filename().string();
  const bool is_plain = tiles == Vec2d(1, 1);
  if (named.uri.empty()) key += " " + std::to_string(image);
  if (!is_plain) {
    for (const double v : {low.x, low.y, tiles.x, tiles.y}) key += " " + std::to_string(static_cast<int>(v));
    key += " " + std::to_string(from.sampler);
  }
  tinygltf::Sampler sampler;
  if (from.sampler >= 0) sampler = element(model_.samplers, from.sampler, "a sampler");
  AlphaPicture alpha;
  const auto make = [&](std::uint64_t max_memory) {
    TransparentImage whole = picture(image, max_memory);
    if (!is_plain) whole = continued(whole, sampler, low, tiles, max_memory);
    alpha = {whole.colors.width, whole.colors.height, std::move(whole.alpha)};
    return std::move(whole.colors);
  };
  const std::optional<TextureIndex> place =
      textures_.intern(key, name, make, builder_.scene().textures, builder_.notes());
  if (place && !alpha.alpha.empty()) alphas_[*place] = std::move(alpha);
  return place;
}

TextureIndex GltfMaterials::add(Texture texture) {
  std::vector<Texture>& textures = builder_.scene().textures;
  textures.push_back(std::move(texture));
  return static_cast<TextureIndex>(textures.size() - 1);
}

void GltfMaterials::cut(const GltfSurface& surface, const Material& material, ModelMesh& mesh) {
  if (!surface.cutoff || !material.texture) return;
  const auto alpha = alphas_.find(*material.texture);
  if (alpha == alphas_.end()) return;
  if (!cut_holes(mesh, alpha->second, *surface.cutoff)) losses_.add(ModelLoss::kHoles);
}

// Data pictures count as they are.
std::array<double, 4> GltfMaterials::mean(int texture) {
  try {
    const tinygltf::Texture& from = element(model_.textures, texture, "a texture");
    const TransparentImage image = picture(from.source, max_memory_);
    std::array<double, 4> sum{};
    for (const Color& pixel : image.colors.pixels) {
      for (std::size_t i = 0; i < 3; ++i) sum[i] += static_cast<double>(pixel[static_cast<int>(i)]);
    }
    for (double& v : sum) v /= static_cast<double>(std::max<std::size_t>(image.colors.pixels.size(), 1));
    sum[3] = AlphaPicture{image.colors.width, image.colors.height, image.alpha}.mean();
    return sum;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return {1, 1, 1, 1};  // as the factors alone say
  }
}

TransparentImage GltfMaterials::picture(int image, std::uint64_t max_memory) {
  const tinygltf::Image& from = element(model_.images, image, "a picture");
  if (from.bufferView >= 0) return decode_transparent_image(bytes_of(model_, from.bufferView), max_memory);
  if (from.uri.empty())
    return decode_transparent_image({reinterpret_cast<const char*>(from.image.data()), from.image.size()},
                                    max_memory);
  const std::string path = folder_.find(from.uri).string();
  files_.opened.push_back(path);
  return decode_transparent_image(read_whole_file(path), max_memory);
}

}  // namespace pprt
