#include <catch2/catch.hpp>

#include "scene/description/scene_description.h"

namespace pprt::material_table_test {

namespace {

Material with_diffuse(double diffuse) {
  Material material;
  material.diffuse = diffuse;
  return material;
}

}  // namespace

TEST_CASE("equal materials share an index, different ones do not") {
  std::vector<Material> materials;
  MaterialTable table;
  CHECK(table.intern(materials, with_diffuse(0.5)) == 0);
  CHECK(table.intern(materials, with_diffuse(0.25)) == 1);
  CHECK(table.intern(materials, with_diffuse(0.5)) == 0);
  CHECK(materials.size() == 2);
}

TEST_CASE("every field tells materials apart") {
  std::vector<Material> materials;
  MaterialTable table;
  table.intern(materials, {});
  const auto is_new = [&](const Material& changed) {
    const std::size_t before = materials.size();
    return table.intern(materials, changed) == before && materials.size() == before + 1;
  };
  for (double Material::*field : {&Material::diffuse, &Material::specular, &Material::shine,
                                  &Material::transmittance, &Material::refractive_index}) {
    Material changed;
    changed.*field = 0.125;
    CHECK(is_new(changed));
  }
  for (int channel = 0; channel < 3; ++channel) {
    Material changed;
    changed.color[channel] = 0.125;
    CHECK(is_new(changed));
  }
  for (int channel = 0; channel < 3; ++channel) {
    Material changed;
    changed.emission[channel] = 0.125;
    CHECK(is_new(changed));
  }
  Material pictured;
  pictured.emission_texture = 0;
  CHECK(is_new(pictured));
  CHECK(materials.size() == 13);
}

TEST_CASE("zero and minus zero are one value") {
  std::vector<Material> materials;
  MaterialTable table;
  CHECK(table.intern(materials, with_diffuse(0.0)) == table.intern(materials, with_diffuse(-0.0)));
}

TEST_CASE("indices stay the same while the table grows") {
  std::vector<Material> materials;
  MaterialTable table;
  for (int round = 0; round < 2; ++round) {
    for (MaterialIndex i = 0; i < 10000; ++i) REQUIRE(table.intern(materials, with_diffuse(i)) == i);
  }
  CHECK(materials.size() == 10000);
}

TEST_CASE("a fresh table takes up materials that are there already") {
  std::vector<Material> materials;
  for (int i = 0; i < 100; ++i) materials.push_back(with_diffuse(i));
  MaterialTable table;
  CHECK(table.intern(materials, with_diffuse(77)) == 77);
  CHECK(table.intern(materials, with_diffuse(1000)) == 100);
}

}  // namespace pprt::material_table_test
