// What formats cannot hold is left out, told, and made up for where possible.
#include "convert/losses.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/description/shading_rules.h"

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

TEST_CASE("losses: suns stand far away in their direction, and a sky leaves its ground's colour") {
  SceneDescription scene = textured_ball();
  scene.materials[0] = {.color = {1, 1, 1}};
  scene.spheres[0].center = {5, 0, 0};
  scene.lights = {{.position = {0, 3, 4}, .is_sun = true}, {.position = {1, 2, 3}}};
  scene.sky = Sky{.horizon = {1, 0, 0}, .zenith = {0, 0, 1}};
  scene.background = Rgb(0, 1, 0);
  const Rgb ground = ground_color(scene);
  const PlainScene plain = for_nff(scene);
  CHECK(plain.losses ==
        std::vector<std::string>{"the sky is not kept: the background has the colour below its horizon",
                                 "1 sun becomes a light far away"});
  CHECK((!plain.scene.sky && plain.scene.background == ground));
  CHECK_FALSE(plain.scene.lights[0].is_sun);
  const Vec3d way = plain.scene.lights[0].position - Vec3d(5, 0, 0);
  CHECK(way.length() == Approx(1e4 * std::sqrt(12.0)));  // sizes of the ball's box
  CHECK((way.normalized() - Vec3d(0, 0.6, 0.8)).length() < 1e-9);
  CHECK(plain.scene.lights[1].position == Vec3d(1, 2, 3));
  scene.lights[1].is_sun = true;
  CHECK(for_nff(scene).losses.back() == "2 suns become lights far away");
  CHECK(for_meshes(scene, true).losses.empty());  // they hold both
}

TEST_CASE("losses: lamps of materials in use are counted, and none glows") {
  SceneDescription scene = textured_ball();
  for (Material& m : scene.materials) m = {}, m.emission = {0, 0.5, 0};
  const PlainScene one = for_nff(scene);
  CHECK(one.losses ==
        std::vector<std::string>{"1 material that gives off light: NFF has none, so it does not glow"});
  for (const Material& m : one.scene.materials) CHECK(m.emission == Rgb(0, 0, 0));
  add_sphere(scene, {{0, 0, 3}, 1, 1, {}});
  CHECK(for_nff(scene).losses ==
        std::vector<std::string>{"2 materials that give off light: NFF has none, so they do not glow"});
}

TEST_CASE("losses: a picture that gives off light leaves its mean, and pictures are counted once") {
  SceneDescription scene = textured_ball();
  scene.textures.push_back(scene.textures[0]);
  scene.materials[0].emission = {1, 1, 0.5};
  scene.materials[0].emission_texture = 1;
  add_sphere(scene, {{0, 0, 3}, 1, 1, {}});  // of the other material, with the first picture, too
  const PlainScene plain = for_meshes(scene, false);
  CHECK(plain.losses ==
        std::vector<std::string>{"2 textures are not kept: their surfaces get their mean colours"});
  CHECK(close(plain.scene.materials[0].emission, {1, 0.2, 0.1}));
  CHECK_FALSE(plain.scene.materials[0].emission_texture);
}

}  // namespace pprt::losses_test
