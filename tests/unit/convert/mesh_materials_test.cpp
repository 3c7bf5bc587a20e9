// Materials as Assimp has them, there and back, without a file between.
#include "convert/mesh/mesh_materials.h"

#include <assimp/material.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "convert/model/display_values.h"

namespace pprt::mesh_materials_test {
namespace {

Material there_and_back(const Material& material, bool physically_based) {
  return to_material(*to_assimp(material, "m", physically_based, {}, 1));
}

aiMaterial named(const char* name) {
  aiMaterial material;
  const aiString text(name);
  material.AddProperty(&text, AI_MATKEY_NAME);
  return material;
}

void set(aiMaterial& material, float value, const char* key, unsigned type, unsigned index) {
  material.AddProperty(&value, 1, key, type, index);
}

void set(aiMaterial& material, const aiColor3D& value, const char* key, unsigned type, unsigned index) {
  material.AddProperty(&value, 1, key, type, index);
}

bool close(const Rgb& a, const Rgb& b) {
  return (a - b).length() < 1e-6;
}

}  // namespace

TEST_CASE("mesh materials: Phong's model keeps each term, the mirror as its highlight") {
  Material m{.color = {0.2, 0.4, 0.8}, .diffuse = 0.5, .specular = 0.25, .shine = 17};
  m.emission = {0.1, 0.2, 0.3};
  Material back = there_and_back(m, false);
  CHECK(close(back.color, {0.1, 0.2, 0.4}));
  CHECK((back.specular == Approx(0.25) && back.shine == Approx(17) && back.transmittance == 0));
  CHECK(close(back.emission, {0.1, 0.2, 0.3}));
  m.transmittance = 0.75, m.refractive_index = 1.25;
  back = there_and_back(m, false);
  CHECK((back.transmittance == Approx(0.75) && back.refractive_index == Approx(1.25)));
  m.terms = {.ambient = {1, 0, 0}, .diffuse = {0, 1, 0.5}, .specular = {0.3, 0.6, 0.9}};
  back = there_and_back(m, false);
  CHECK(close(back.color, {0, 1, 0.5}));
  CHECK(back.specular == Approx(0.6));
}

TEST_CASE("mesh materials: they keep their names") {
  for (const bool physically_based : {true, false})
    CHECK(to_assimp({}, "glass", physically_based, {}, 1)->GetName() == aiString(std::string("glass")));
}

TEST_CASE("mesh materials: physically based, what is mirrored or let through is not reflected to all sides") {
  const auto base_of = [](const Material& m) {
    aiColor4D base;
    REQUIRE(to_assimp(m, "m", true, {}, 1)->Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS);
    return Rgb(base.r, base.g, base.b);
  };
  const auto factor_of = [](const Material& m, const char* key, unsigned type, unsigned index) {
    float value = -1;
    to_assimp(m, "m", true, {}, 1)->Get(key, type, index, value);
    return static_cast<double>(value);
  };
  Material matte{.color = {0.2, 0.4, 0.8}, .diffuse = 0.5};
  CHECK(close(base_of(matte), {light_of(0.1), light_of(0.2), light_of(0.4)}));
  CHECK(factor_of(matte, AI_MATKEY_METALLIC_FACTOR) == 0);
  CHECK(factor_of(matte, AI_MATKEY_ROUGHNESS_FACTOR) == 1);
  CHECK(factor_of(matte, AI_MATKEY_TRANSMISSION_FACTOR) == -1);
  CHECK(factor_of(matte, AI_MATKEY_OPACITY) == 1);
  Material mirror = matte;
  mirror.specular = 0.5;
  CHECK(close(base_of(mirror), {light_of(0.2), light_of(0.4), light_of(0.8)}));
  CHECK(factor_of(mirror, AI_MATKEY_METALLIC_FACTOR) == 0.5);
  CHECK(factor_of(mirror, AI_MATKEY_ROUGHNESS_FACTOR) == 0);
  Material glass = matte;
  glass.transmittance = 0.25, glass.specular = 0.5, glass.refractive_index = 1.25;
  const double left = 0.75 * 0.5;
  CHECK(close(base_of(glass), {light_of(0.1 / left), light_of(0.2 / left), 1}));  // no more than all of it
  CHECK(factor_of(glass, AI_MATKEY_TRANSMISSION_FACTOR) == 0.5);
  CHECK(factor_of(glass, AI_MATKEY_REFRACTI) == 1.25);
  CHECK(factor_of(glass, AI_MATKEY_OPACITY) == 1);
  // It is clear, and bends light only where it is thick.
  glass.specular = 0;
  CHECK(factor_of(glass, AI_MATKEY_ROUGHNESS_FACTOR) == 0);
  float thick = 0;
  to_assimp(glass, "m", true, {}, 0.5)->Get(AI_MATKEY_VOLUME_THICKNESS_FACTOR, thick);
  CHECK(thick == 0.5F);
  glass.refractive_index = 1;
  CHECK(factor_of(glass, AI_MATKEY_VOLUME_THICKNESS_FACTOR) == -1);
  Material lamp = matte;
  lamp.emission = {4, 0.5, 0};
  aiColor3D emitted;
  REQUIRE(to_assimp(lamp, "m", true, {}, 1)->Get(AI_MATKEY_COLOR_EMISSIVE, emitted) == aiReturn_SUCCESS);
  CHECK(close(Rgb(emitted.r, emitted.g, emitted.b), {1, light_of(0.5), 0}));
  CHECK(to_assimp(matte, "m", true, {}, 1)->Get(AI_MATKEY_COLOR_EMISSIVE, emitted) != aiReturn_SUCCESS);
}

TEST_CASE(
    "mesh materials: what a file does not say is NFF's default, and what is out of range is brought in") {
  CHECK(there_and_back({}, false).color == Rgb(1, 1, 1));
  aiMaterial nothing = named("red");
  const Material plain = to_material(nothing);
  CHECK((plain.color == Rgb(1, 1, 1) && plain.specular == 0 && plain.transmittance == 0));
  aiMaterial own = named(AI_DEFAULT_MATERIAL_NAME);
  set(own, aiColor3D(0.6F, 0.6F, 0.6F), AI_MATKEY_COLOR_DIFFUSE);
  CHECK(to_material(own).color == Rgb(1, 1, 1));
  aiMaterial wild = named("wild");
  set(wild, aiColor3D(2, -1, 0.5F), AI_MATKEY_COLOR_DIFFUSE);
  set(wild, aiColor3D(3, 3, 3), AI_MATKEY_COLOR_SPECULAR);
  CHECK(to_material(wild).specular == 0);  // a highlight without a size is none
  set(wild, 0, AI_MATKEY_SHININESS);
  set(wild, -2, AI_MATKEY_OPACITY);
  const Material brought = to_material(wild);
  CHECK(brought.color == Rgb(1, 0, 0.5));
  CHECK((brought.specular == 1 && brought.shine == Material().shine && brought.transmittance == 1));
  CHECK(brought.refractive_index == 1.5);  // glass that names no index
  set(wild, 1.2F, AI_MATKEY_REFRACTI);
  CHECK(to_material(wild).refractive_index == Approx(1.2));
}

TEST_CASE("mesh materials: a metal mirrors as far as it is smooth, and is rough where nothing else is said") {
  const auto specular = [](float metallic, std::optional<float> rough) {
    aiMaterial material = named("metal");
    set(material, metallic, AI_MATKEY_METALLIC_FACTOR);
    if (rough) set(material, *rough, AI_MATKEY_ROUGHNESS_FACTOR);
    return to_material(material).specular;
  };
  CHECK(specular(1, 0.25F) == Approx(0.75));
  CHECK(specular(0.5F, 0) == Approx(0.5));
  CHECK(specular(1, {}) == 0);
}

TEST_CASE("mesh materials: pictures have their paths, that of the base colour first") {
  const auto material = to_assimp({}, "m", true, {"a.png", "b.png"}, 1);
  CHECK((picture_path(*material) == "a.png" && emission_path(*material) == "b.png"));
  const auto phong = to_assimp({}, "m", false, {"a.png", ""}, 1);
  CHECK((picture_path(*phong) == "a.png" && emission_path(*phong).empty()));
  aiMaterial both = named("both");
  const aiString diffuse("diffuse.png"), base("base.png");
  both.AddProperty(&diffuse, AI_MATKEY_TEXTURE_DIFFUSE(0));
  CHECK(picture_path(both) == "diffuse.png");
  both.AddProperty(&base, AI_MATKEY_TEXTURE(aiTextureType_BASE_COLOR, 0));
  CHECK(picture_path(both) == "base.png");
  CHECK(picture_path(named("none")).empty());
}

}  // namespace pprt::mesh_materials_test
