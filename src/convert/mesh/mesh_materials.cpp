#include "convert/mesh/mesh_materials.h"

#include <assimp/material.h>
#include <assimp/mesh.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>
#include <string_view>

#include "convert/mesh/assimp_values.h"
#include "convert/model/display_values.h"
#include "scene/description/shading_rules.h"

namespace pprt {
namespace {

constexpr double kDefaultGlassIndex = 1.5;  // of transparent materials that name none

double unit_interval(double v) {
  return std::isfinite(v) ? std::clamp(v, 0.0, 1.0) : 0;
}

Rgb to_rgb(const aiColor3D& c) {
  return {unit_interval(c.r), unit_interval(c.g), unit_interval(c.b)};
}

bool has_picture(const aiMaterial& from, std::initializer_list<aiTextureType> types) {
  return std::any_of(types.begin(), types.end(),
                     [&](aiTextureType type) { return from.GetTextureCount(type) > 0; });
}

}  // namespace

Material to_material(const aiMaterial& from) {
  Material material;
  if (std::string_view(const_cast<aiMaterial&>(from).GetName().C_Str()) == AI_DEFAULT_MATERIAL_NAME)
    return material;
  aiColor3D color(1, 1, 1);
  aiColor4D base;
  if (from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
    material.color = to_rgb(color);
  } else if (from.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS) {
    material.color = to_rgb(aiColor3D(base.r, base.g, base.b));
  }
  if (from.Get(AI_MATKEY_COLOR_EMISSIVE, color) == aiReturn_SUCCESS) material.emission = to_rgb(color);
  float value = 0;
  // The PLY reader invents a highlight without a size.
  if (from.Get(AI_MATKEY_COLOR_SPECULAR, color) == aiReturn_SUCCESS &&
      from.Get(AI_MATKEY_SHININESS, value) == aiReturn_SUCCESS) {
    material.specular = unit_interval((color.r + color.g + color.b) / 3);
    if (value > 0) material.shine = value;
  } else if (from.Get(AI_MATKEY_METALLIC_FACTOR, value) == aiReturn_SUCCESS) {
    float rough = 1;
    from.Get(AI_MATKEY_ROUGHNESS_FACTOR, rough);
    material.specular = unit_interval(value * (1 - unit_interval(rough)));
  }
  if (from.Get(AI_MATKEY_OPACITY, value) == aiReturn_SUCCESS)
    material.transmittance = 1 - unit_interval(value);
  if (material.transmittance > 0) {
    const bool given = from.Get(AI_MATKEY_REFRACTI, value) == aiReturn_SUCCESS && value > 0;
    material.refractive_index = given ? value : kDefaultGlassIndex;
  }
  return material;
}

std::string picture_path(const aiMaterial& from) {
  aiString path;
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    if (from.GetTexture(type, 0, &path) == aiReturn_SUCCESS && path.length > 0) return path.C_Str();
  }
  return {};
}

std::string emission_path(const aiMaterial& from) {
  aiString path;
  return from.GetTexture(aiTextureType_EMISSIVE, 0, &path) == aiReturn_SUCCESS ? path.C_Str() : "";
}

bool has_normal_map(const aiMaterial& from) {
  return has_picture(from, {aiTextureType_NORMALS, aiTextureType_HEIGHT});
}

bool has_other_pictures(const aiMaterial& from) {
  return has_picture(from, {aiTextureType_OPACITY, aiTextureType_SPECULAR, aiTextureType_SHININESS,
                            aiTextureType_METALNESS, aiTextureType_DIFFUSE_ROUGHNESS});
}

std::vector<Rgb> vertex_colors(const aiMesh& from) {
  std::vector<Rgb> colors;
  if (from.mColors[0] == nullptr) return colors;
  for (const aiColor4D& c : std::span(from.mColors[0], from.mNumVertices))
    colors.push_back(to_rgb(aiColor3D(c.r, c.g, c.b)));
  return colors;
}

std::unique_ptr<aiMaterial> to_assimp(const Material& m, const std::string& name_in_file,
                                      bool physically_based, const MaterialPictures& pictures,
                                      double thickness) {
  auto material = std::make_unique<aiMaterial>();
  const aiString name(name_in_file);
  const aiColor3D diffuse = to_color(m.terms ? m.terms->diffuse : m.color * m.diffuse);
  const auto opacity = static_cast<float>(physically_based ? 1 : 1 - m.transmittance);  // else transmission
  const auto mirror = static_cast<float>(m.specular);
  material->AddProperty(&name, AI_MATKEY_NAME);
  material->AddProperty(&opacity, 1, AI_MATKEY_OPACITY);
  const aiString file(pictures.color), light(pictures.emission);
  if (file.length > 0) material->AddProperty(&file, AI_MATKEY_TEXTURE_DIFFUSE(0));
  if (light.length > 0) material->AddProperty(&light, AI_MATKEY_TEXTURE_EMISSIVE(0));
  Rgb emission = m.emission;
  for (int i = 0; i < 3; ++i) {
    emission[i] = std::clamp(emission[i], 0.0, 1.0);
    if (physically_based) emission[i] = light_of(emission[i]);
  }
  const aiColor3D emitted = to_color(emission);
  if (emission != Rgb(0, 0, 0)) material->AddProperty(&emitted, 1, AI_MATKEY_COLOR_EMISSIVE);
  if (physically_based) {
    // Of a physically based material, what is mirrored or let through is not reflected to all sides.
    const double left = (1 - m.transmittance) * (1 - m.specular);
    const auto light_share = [&](float v) {
      return static_cast<float>(light_of(left > 0 ? std::min(static_cast<double>(v) / left, 1.0) : v));
    };
    const aiColor4D base(light_share(diffuse.r), light_share(diffuse.g), light_share(diffuse.b), 1);
    const auto glass = static_cast<float>(effective_refractive_index(m));
    const auto through = static_cast<float>(std::min(m.transmittance / std::max(1 - m.specular, 1e-9), 1.0));
    const auto thick = static_cast<float>(thickness);
    if (m.transmittance > 0) {
      material->AddProperty(&glass, 1, AI_MATKEY_REFRACTI);
      material->AddProperty(&through, 1, AI_MATKEY_TRANSMISSION_FACTOR);
      if (glass != 1) material->AddProperty(&thick, 1, AI_MATKEY_VOLUME_THICKNESS_FACTOR);
    }
    const int both_sides = 1;
    material->AddProperty(&both_sides, 1, AI_MATKEY_TWOSIDED);
    const float roughness = m.specular > 0 || m.transmittance > 0 ? 0 : 1;
    material->AddProperty(&base, 1, AI_MATKEY_BASE_COLOR);
    material->AddProperty(&mirror, 1, AI_MATKEY_METALLIC_FACTOR);
    material->AddProperty(&roughness, 1, AI_MATKEY_ROUGHNESS_FACTOR);
    if (file.length > 0) material->AddProperty(&file, AI_MATKEY_TEXTURE(aiTextureType_BASE_COLOR, 0));
    return material;
  }
  const aiColor3D specular = m.terms ? to_color(m.terms->specular) : aiColor3D(mirror, mirror, mirror);
  const int model = aiShadingMode_Phong;
  const auto shine = static_cast<float>(m.shine);
  const auto index = static_cast<float>(effective_refractive_index(m));
  if (m.terms) {
    const aiColor3D ambient = to_color(m.terms->ambient);
    material->AddProperty(&ambient, 1, AI_MATKEY_COLOR_AMBIENT);
  }
  material->AddProperty(&diffuse, 1, AI_MATKEY_COLOR_DIFFUSE);
  material->AddProperty(&specular, 1, AI_MATKEY_COLOR_SPECULAR);
  material->AddProperty(&model, 1, AI_MATKEY_SHADING_MODEL);
  material->AddProperty(&shine, 1, AI_MATKEY_SHININESS);
  material->AddProperty(&index, 1, AI_MATKEY_REFRACTI);
  return material;
}

}  // namespace pprt
