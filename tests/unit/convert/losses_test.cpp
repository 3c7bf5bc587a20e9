// What formats cannot hold is left out, told, and made up for where possible.
#include "convert/losses.h"

#include <catch2/catch.hpp>

namespace pprt::losses_test {
namespace {

// A ball of a texture of two texels, and a material that nothing has.
SceneDescription textured_ball() {
  SceneDescription scene;
  scene.textures.resize(1);
  scene.textures[0].width = 2, scene.textures[0].height = 1;
  scene.textures[0].rgb = {255, 0, 51, 255, 102, 51};
  Material material{.color = {1, 0.5, 1}};
  material.texture = 0;
  material.terms = {.ambient = {0.5, 0.5, 0.5}, .diffuse = {1, 1, 0.5}, .specular = {0, 0, 0}};
  scene.materials = {material, material};
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  return scene;
}

bool close(const Rgb& a, const Rgb& b) {
  return (a - b).length() < 1e-9;
}

}  // namespace

TEST_CASE("losses: a texture that is not kept leaves its mean colour in every term") {
  for (const bool is_mesh : {false, true}) {
    const PlainScene plain = is_mesh ? for_meshes(textured_ball(), false) : for_nff(textured_ball());
    CHECK(plain.losses ==
          std::vector<std::string>{"1 texture is not kept: its surfaces get its mean colour"});
    const Material& m = plain.scene.materials[0];
    CHECK_FALSE(m.texture);
    CHECK(close(m.color, {1, 0.1, 0.2}));
    CHECK(close(m.terms->ambient, {0.5, 0.1, 0.1}));
    CHECK(close(m.terms->diffuse, {1, 0.2, 0.1}));
  }
  CHECK(for_meshes(textured_ball(), true).losses.empty());
  CHECK(for_meshes(textured_ball(), true).scene.materials[0].texture);
}

TEST_CASE("losses: what no object has is not told") {
  SceneDescription scene = textured_ball();
  scene.materials[0] = {};
  CHECK(for_nff(scene).losses.empty());
  scene.materials[1].terms->specular = {0, 0.5, 1};
  CHECK(for_nff(scene).losses.empty());
  scene.materials[0].terms = scene.materials[1].terms;
  CHECK(for_nff(scene).losses ==
        std::vector<std::string>{"1 material with a coloured highlight and mirror: it becomes white"});
}

TEST_CASE("losses: without ambient light NFF's lights are as bright as they were, by its rule for many") {
  SceneDescription scene = textured_ball();
  scene.materials[0] = {};
  scene.ambient = Rgb(0.1, 0.1, 0.1);
  CHECK(for_nff(scene).losses ==
        std::vector<std::string>{"the ambient light and its colours are not kept: NFF has none"});
  scene.lights = {{{1, 2, 3}, std::nullopt, {}}, {{3, 2, 1}, Rgb(0.5, 0, 1), {}}, {}, {}};
  const PlainScene plain = for_nff(scene);
  REQUIRE(plain.losses.size() == 2);
  CHECK(plain.losses[1] == "the lights are made 4.00 times as bright, as readers of NFF weaken them");
  CHECK(close(*plain.scene.lights[0].color, {4, 4, 4}));
  CHECK(close(*plain.scene.lights[1].color, {2, 0, 4}));
  CHECK(for_meshes(scene, true).losses == std::vector<std::string>{"the ambient light is not kept"});
}

}  // namespace pprt::losses_test
