// Textures, and materials with a colour for each term.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "trace/textures/texture_image.h"
#include "unit/trace/test_scenes.h"

namespace pprt::surfaces_test {

using namespace pprt::test;

namespace {

// Red, green / blue, white.
Texture four_texels() {
  return {"t", 2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
}

bool close(const Color& a, const Color& b) {
  const Color d = a - b;
  return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < 1e-5;
}

// The square [-1, 1]^2 at z = 0 as two triangles, seen from the front, with the picture upright on it.
SceneDescription textured_square(const TermColors& terms) {
  SceneDescription scene;
  scene.name = "t";
  scene.ambient = Rgb(1, 1, 1);
  scene.textures = {four_texels()};
  scene.materials.emplace_back();
  scene.materials[0].terms = terms;
  scene.materials[0].specular = std::max({terms.specular.x, terms.specular.y, terms.specular.z});
  scene.materials[0].texture = 0;
  const TriangleMesh mesh{.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
                          .normals = {},
                          .texture_points = {{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  std::vector<TriangleCorners> corners(2);
  corners[0].position = corners[0].texture_point = {0, 1, 2};
  corners[1].position = corners[1].texture_point = {0, 2, 3};
  add_mesh(scene, mesh, corners);
  scene.view = view_from({0, 0, 10}, {0, 0, 0});
  return scene;
}

Color seen_at(const SceneDescription& scene, double x, double y, const CompileOptions& options = {}) {
  return look(compile(scene, options), view_from({x, y, 10}, {x, y, 0})).color;
}

}  // namespace

TEST_CASE("textures: texels keep their colours at their middles, v runs down, and pictures repeat") {
  const TextureImage image(four_texels());
  const Color red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1), white(1, 1, 1);
  CHECK(close(image.at({0.25, 0.25}), red));
  CHECK(close(image.at({0.75, 0.25}), green));
  CHECK(close(image.at({0.25, 0.75}), blue));
  CHECK(close(image.at({0.75, 0.75}), white));
  CHECK(close(image.at({-0.75, 3.25}), red));
  CHECK(close(image.at({5.75, -7.25}), white));
  CHECK(close(image.at({0.5, 0.25}), (red + green) * 0.5F));
  CHECK(close(image.at({0, 0.25}), (red + green) * 0.5F));  // across the edge, where it repeats
  CHECK(close(image.at({0.5, 0.5}), (red + green + blue + white) * 0.25F));
  for (const double far : {1e300, -1e300, std::nan(""), HUGE_VAL}) CHECK(image.at({far, 0.25}).x >= 0);
}

TEST_CASE("textures: one of a single texel is that colour everywhere") {
  const TextureImage image({"t", 1, 1, {51, 102, 255}});
  for (const double x : {-0.3, 0.0, 0.5, 0.999}) CHECK(close(image.at({x, 1 - x}), Color(0.2F, 0.4F, 1)));
}

TEST_CASE("textures: they multiply the ambient and the diffuse term, and neither highlight nor mirror") {
  TermColors terms{.ambient = {.5, .5, .5}, .diffuse = {0, 0, 0}, .specular = {0, 0, 0}};
  SceneDescription scene = textured_square(terms);
  CHECK(close(seen_at(scene, -0.5, 0.5), Color(0.5F, 0, 0)));
  CHECK(close(seen_at(scene, 0.5, -0.5), Color(0.5F, 0.5F, 0.5F)));
  scene.ambient = Rgb(2, 1, 1);
  CHECK(close(seen_at(scene, -0.5, 0.5), Color(1, 0, 0)));

  // A light above the point, of which all is reflected, and no weight.
  scene.materials[0].terms = TermColors{.ambient = {0, 0, 0}, .diffuse = {.5, .5, .5}, .specular = {0, 0, 0}};
  scene.lights = {{{0.5, 0.5, 100}, Rgb(.8, .8, .8), {}}, {{0.5, 0.5, 50}, Rgb(.4, .4, .4), {}}};
  CHECK(close(seen_at(scene, 0.5, 0.5), Color(0, 0.6F, 0)));

  scene.materials[0].terms =
      TermColors{.ambient = {0, 0, 0}, .diffuse = {0, 0, 0}, .specular = {.5, .25, .1}};
  scene.materials[0].specular = .5, scene.materials[0].shine = 10;
  CHECK(close(seen_at(scene, 0.5, 0.5), Color(0.6F, 0.3F, 0.12F)));
  scene.lights.clear();
  scene.background = Rgb(1, 1, 1);
  CHECK(close(seen_at(scene, 0.5, 0.5), Color(0.5F, 0.25F, 0.1F)));
}

TEST_CASE("textures: what gives off light has a picture of its own, which is not that of the colour") {
  SceneDescription scene =
      textured_square({.ambient = {.5, .5, .5}, .diffuse = {0, 0, 0}, .specular = {0, 0, 0}});
  Material& m = scene.materials[0];
  m.emission = {.25, .25, 2};
  CHECK(close(seen_at(scene, -0.5, 0.5), Color(.75F, .25F, 2)));  // even, over a red texel
  scene.textures.push_back({"glow", 1, 2, {0, 255, 0, 255, 255, 255}});
  m.emission_texture = 1;
  CHECK(close(seen_at(scene, -0.5, 0.5), Color(.5F, .25F, 0)));
  CHECK(close(seen_at(scene, -0.5, -0.5), Color(.25F, .25F, 2.5F)));
  m.texture.reset();
  CHECK(compile(scene).effects().has(Effect::kTextures));
  CHECK(close(seen_at(scene, -0.5, 0.5), Color(.5F, .75F, .5F)));
  CompileOptions without;
  without.effects = parse_effects("textures");
  CHECK(close(seen_at(scene, -0.5, 0.5, without), Color(.5F, .5F, .5F)));
}

TEST_CASE("textures: an effect that can be left out") {
  const SceneDescription scene =
      textured_square({.ambient = {.5, .4, .3}, .diffuse = {0, 0, 0}, .specular = {0, 0, 0}});
  CHECK(compile(scene).effects().has(Effect::kTextures));
  const std::string census = compile(scene).census();
  CHECK(census.find("textures    1 picture; 0.00 MB, smaller") != std::string::npos);
  CompileOptions without;
  without.effects = parse_effects("none");
  CHECK(close(seen_at(scene, -0.5, 0.5, without), Color(0.5F, 0.4F, 0.3F)));
  CHECK(compile(scene, without).census().find("1 picture") == std::string::npos);
  SceneDescription plain = scene;
  plain.materials[0].texture.reset();
  CHECK_FALSE(compile(plain).effects().has(Effect::kTextures));
}

TEST_CASE("materials: refracted and totally reflected rays count by the transmittance") {
  // A sheet of glass over a red floor, under a blue sky.
  const auto seen = [](bool has_terms, double transmittance, double degrees, bool from_within) {
    Material glass;
    glass.color = {0, 0, 0}, glass.transmittance = transmittance, glass.refractive_index = 1.5;
    if (has_terms)
      glass.terms = TermColors{.ambient = {0, 0, 0}, .diffuse = {0, 0, 0}, .specular = {0, 0, 0}};
    SceneDescription scene = scene_with(glass);
    scene.lights.clear();
    scene.background = Rgb(0, 0, 1);
    scene.ambient = Rgb(1, 1, 1);
    scene.materials.emplace_back().terms =
        TermColors{.ambient = {1, 0, 0}, .diffuse = {0, 0, 0}, .specular = {0, 0, 0}};
    add_square(scene, 3, 0);
    add_square(scene, 100, -20, 1);
    const double angle = degrees * std::numbers::pi / 180, height = 10 * std::cos(angle);
    return look(compile(scene),
                view_from({10 * std::sin(angle), 0, from_within ? -height : height}, {0, 0, 0}))
        .color;
  };
  for (const float t : {0.5F, 0.125F}) {
    CAPTURE(t);
    for (const bool has_terms : {true, false}) {
      CAPTURE(has_terms);
      CHECK(close(seen(has_terms, t, 40, false), Color(t, 0, 0)));
      CHECK(close(seen(has_terms, t, 41.7, true), Color(0, 0, t)));  // the critical angle is 41.81 degrees
    }
    CHECK(close(seen(true, t, 41.9, true), Color(t, 0, 0)));
    CHECK(close(seen(false, t, 41.9, true), Color(0, 0, 0)));  // NFF's glass shows nothing there
  }
}

}  // namespace pprt::surfaces_test
