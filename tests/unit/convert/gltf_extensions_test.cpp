// What extensions of glTF say, and what lights are worth within a scene.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "convert/gltf/gltf_holes.h"
#include "convert/model/display_values.h"
#include "image/image_io.h"
#include "scene/description/shading_rules.h"
#include "unit/convert/gltf_sample.h"

namespace pprt::gltf_extensions_test {
namespace {

using nlohmann::json;

constexpr const char* kGlossiness = "KHR_materials_pbrSpecularGlossiness";

const Material& material_of(const SceneDescription& scene) {
  return scene.materials.at(material_of(scene, scene.order.at(0)));
}

bool tells_of_tint(const ReadMesh& read) {
  return std::any_of(read.notes.begin(), read.notes.end(), [](const std::string& note) {
    return note.find("coloured glass") != std::string::npos;
  });
}

}  // namespace

TEST_CASE("gltf extensions: the colour of the older materials counts, and they are no metal") {
  GltfSample sample;
  sample.triangle_of({{"pbrMetallicRoughness",
                       {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 1}, {"roughnessFactor", 0}}},
                      {"extensions", {{kGlossiness, {{"diffuseFactor", {0.5, 0.25, 0.125, 1}}}}}}});
  const SceneDescription scene = sample.read().scene;
  const Material& material = material_of(scene);
  CHECK(material.color.x == Approx(display_value(0.5)));
  CHECK(material.color.y == Approx(display_value(0.25)));
  CHECK(material.color.z == Approx(display_value(0.125)));
  CHECK((material.specular == 0 && !material.texture));
  // Without a factor that of the newer way counts.
  GltfSample plain;
  plain.triangle_of({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}},
                     {"extensions", {{kGlossiness, json::object()}}}});
  CHECK(material_of(plain.read().scene).color == Rgb(1, 0, 0));
}

TEST_CASE("gltf extensions: the picture of the older materials is shown by its own coordinates") {
  GltfSample sample;
  Image picture(2, 2);
  picture.at(1, 0) = Color(1, 1, 1);
  write_image(sample.folder() / "a.png", picture);
  const int texture = sample.texture("a.png");
  const int other_places = sample.numbers({0.25, 0.5, 0.75, 0.5, 0.25, 1}, "VEC2");
  const int material = sample.add(
      "materials",
      {{"extensions", {{kGlossiness, {{"diffuseTexture", {{"index", texture}, {"texCoord", 1}}}}}}}});
  sample.node(
      {{"mesh", sample.triangle({{"material", material}, {"attributes", {{"TEXCOORD_1", other_places}}}})}});
  const SceneDescription scene = sample.read().scene;
  REQUIRE((scene.meshes.size() == 1 && scene.textures.size() == 1));
  CHECK(material_of(scene).texture == TextureIndex{0});
  CHECK(scene.meshes[0].texture_points == std::vector<Vec2d>{{0.25, 0.5}, {0.75, 0.5}, {0.25, 1}});
}

TEST_CASE("gltf extensions: of glass that colours the light the colour is told to be lost") {
  const auto read = [](const json& extensions) {
    GltfSample sample;
    sample.triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"extensions", extensions}});
    return sample.read();
  };
  const json glass = {{"transmissionFactor", 0.75}};
  const ReadMesh plain =
      read({{"KHR_materials_transmission", glass}, {"KHR_materials_volume", {{"thicknessFactor", 0.1}}}});
  CHECK_FALSE(tells_of_tint(plain));
  CHECK(material_of(plain.scene).transmittance == 0.75);
  CHECK(material_of(plain.scene).refractive_index == 1.5);
  const ReadMesh tinted =
      read({{"KHR_materials_transmission", glass},
            {"KHR_materials_volume", {{"thicknessFactor", 0.1}, {"attenuationColor", {1, 0.5, 1}}}}});
  CHECK(tells_of_tint(tinted));
  const auto tells_of_picture = [](const ReadMesh& mesh) {
    return std::count(mesh.notes.begin(), mesh.notes.end(),
                      "1 material with a picture of how much light it lets through: it does so all over");
  };
  CHECK(tells_of_picture(plain) == 0);
  const json pattern = {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", 0}}}};
  CHECK(tells_of_picture(read({{"KHR_materials_transmission", pattern}})) == 1);
  CHECK(material_of(tinted.scene) == material_of(plain.scene));
}

TEST_CASE("gltf extensions: glass bends light where it has a thickness, and is a thin wall without") {
  const auto read = [](const json& volume, const json& more = json::object()) {
    json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"extensions", more}};
    material["extensions"]["KHR_materials_ior"] = {{"ior", 1.25}};
    if (!volume.is_null()) material["extensions"]["KHR_materials_volume"] = volume;
    GltfSample sample;
    sample.triangle_of(material);
    return material_of(sample.read().scene);
  };
  const json glass = {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}};
  const Material thick = read({{"thicknessFactor", 2}}, glass);
  CHECK((thick.transmittance == 0.5 && thick.refractive_index == 1.25));
  for (const json& volume : {json(), json::object(), json{{"thicknessFactor", 0}}}) {
    const Material thin = read(volume, glass);
    CHECK((thin.transmittance == 0.5 && thin.refractive_index == 1 && !thin.terms));
  }
  CHECK(read({{"thicknessFactor", 2}}).refractive_index == 1);  // lets nothing through
  GltfSample smoke;  // what is transparent by its alpha bends nothing
  smoke.triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {1, 1, 1, 0.5}}}},
                     {"alphaMode", "BLEND"},
                     {"extensions", {{"KHR_materials_volume", {{"thicknessFactor", 2}}}}}});
  const Material through = material_of(smoke.read().scene);
  CHECK((through.transmittance == 0.5 && through.refractive_index == 1));
  // What is reflected totally within is seen; all else is as without terms.
  REQUIRE(thick.terms);
  CHECK(thick.terms->ambient == thick.color * kAmbientReflectance);
  CHECK(thick.terms->diffuse == thick.color);
  CHECK(thick.terms->specular == Rgb(0, 0, 0));
}

TEST_CASE("gltf extensions: rough glass, highlights on no metal and open one-sided meshes are told") {
  const auto tells = [](json pbr, const json& extensions, const char* line, bool is_double_sided = false) {
    GltfSample sample;
    sample.triangle_of({{"pbrMetallicRoughness", std::move(pbr)},
                        {"doubleSided", is_double_sided},
                        {"extensions", extensions}});
    const std::vector<std::string> notes = sample.read().notes;
    return std::count(notes.begin(), notes.end(), line) == 1;
  };
  const json glass = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}, none = json::object();
  const char* rough = "1 material of rough glass: it is clear";
  CHECK(tells({{"metallicFactor", 0}, {"roughnessFactor", 0.2}}, glass, rough));
  CHECK(tells({{"metallicFactor", 0}}, glass, rough));  // as rough as can be
  CHECK_FALSE(tells({{"metallicFactor", 0}, {"roughnessFactor", 0}}, glass, rough));
  CHECK_FALSE(tells({{"metallicFactor", 0}, {"roughnessFactor", 0.2}}, none, rough));
  const char* highlight = "1 smooth material that is no metal: its highlight is not shown";
  CHECK(tells({{"metallicFactor", 0}, {"roughnessFactor", 0.2}}, none, highlight));
  CHECK_FALSE(tells({{"metallicFactor", 0}, {"roughnessFactor", 0.2}}, glass, highlight));
  CHECK_FALSE(tells({{"metallicFactor", 0}, {"roughnessFactor", 0.6}}, none, highlight));
  CHECK_FALSE(tells({{"metallicFactor", 0.1}, {"roughnessFactor", 0.2}}, none, highlight));
  CHECK_FALSE(tells({{"metallicFactor", 0}, {"roughnessFactor", 0.2}},
                    {{"KHR_materials_unlit", json::object()}}, highlight));
  // The older materials are as rough as they do not gloss, which they do without a word.
  CHECK(tells(none, {{kGlossiness, json::object()}}, highlight));
  CHECK_FALSE(tells(none, {{kGlossiness, {{"glossinessFactor", 0.25}}}}, highlight));
  const char* one_side = "1 open mesh of a one-sided material: it is seen from behind, too";
  CHECK(tells(none, none, one_side));
  CHECK_FALSE(tells(none, none, one_side, true));
  // What mirrors nothing has no highlight.
  const json smooth = {{"metallicFactor", 0}, {"roughnessFactor", 0.2}};
  CHECK_FALSE(tells(smooth, {{"KHR_materials_specular", {{"specularFactor", 0}}}}, highlight));
  CHECK_FALSE(tells(smooth, {{"KHR_materials_ior", {{"ior", 1}}}}, highlight));
}

TEST_CASE("gltf extensions: a mesh of several materials is closed as a whole, and told once") {
  GltfSample sample;
  const int front = sample.numbers({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3"),
            back = sample.numbers({0, 0, 0, 0, 1, 0, 1, 0, 0}, "VEC3");
  const auto material = [&] { return sample.add("materials", {{"name", "one"}, {"doubleSided", false}}); };
  const auto part = [&](int positions) -> json {
    return {{"material", material()}, {"attributes", {{"POSITION", positions}}}};
  };
  const auto told = [](const ReadMesh& read) {
    return std::count(read.notes.begin(), read.notes.end(),
                      "1 open mesh of a one-sided material: it is seen from behind, too");
  };
  const int closed = sample.add("meshes", {{"primitives", {part(front), part(back)}}});
  sample.node({{"mesh", closed}});
  CHECK(told(sample.read()) == 0);
  // Parts may share their positions.
  const auto indices = [&](const std::vector<std::uint16_t>& of) {
    return sample.accessor({reinterpret_cast<const char*>(of.data()), 2 * of.size()},
                           {{"componentType", 5123}, {"count", of.size()}, {"type", "SCALAR"}});
  };
  json one = part(front), other = part(front);
  one["indices"] = indices({0, 1, 2}), other["indices"] = indices({0, 2, 1});
  sample.node({{"mesh", sample.add("meshes", {{"primitives", {one, other}}})}});
  CHECK(told(sample.read()) == 0);
  const int open = sample.add("meshes", {{"primitives", {part(front)}}});
  for (const double x : {0.0, 2.0}) sample.node({{"mesh", open}, {"translation", {x, 0, 0}}});
  CHECK(told(sample.read()) == 1);
  // Without a word a material has one side.
  sample.document["materials"].back().erase("doubleSided");
  sample.keeps_sides = true;
  CHECK(told(sample.read()) == 1);
}

TEST_CASE("gltf extensions: a lamp in the scene's middle counts as one a tenth of its size away") {
  GltfSample sample;
  sample.node({{"mesh", sample.triangle()}});  // its box is 1 wide and high: the square of its size is 2
  sample.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 1}},
      {{"type", "point"}, {"intensity", 1}},
      {{"type", "directional"}, {"intensity", 100}}};
  const std::vector<std::vector<double>> places = {{0.5, 0.5, 0}, {0.5, 0.5, 0.2}, {0, 0, 0}};
  for (int i = 0; i < 3; ++i)
    sample.node({{"translation", places[static_cast<std::size_t>(i)]},
                 {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const std::vector<Light> lights = sample.read().scene.lights;
  REQUIRE(lights.size() == 3);
  CHECK_FALSE(lights[2].color);                                     // the brightest
  CHECK(lights[0].color.value().x == Approx(display_value(0.5)));   // 1 / .02 of 100
  CHECK(lights[1].color.value().x == Approx(display_value(0.25)));  // 1 / .2^2 of 100
}

TEST_CASE("gltf extensions: alpha between texels is that of a straight course, and a picture's repeats") {
  const AlphaPicture picture{2, 2, {0, 1, 0.5F, 0.25F}};
  CHECK(picture.at({0.25, 0.25}) == 0);
  CHECK(picture.at({0.75, 0.25}) == 1);
  CHECK(picture.at({0.25, 0.75}) == 0.5);
  CHECK(picture.at({0.75, 0.75}) == 0.25);
  CHECK(picture.at({0.5, 0.25}) == Approx(0.5));
  CHECK(picture.at({0.25, 0.375}) == Approx(0.125));
  CHECK(picture.at({0.375, 0.625}) ==
        Approx(0.75 * (0.25 * 0 + 0.75 * 0.5) + 0.25 * (0.25 * 1 + 0.75 * 0.25)));
  CHECK(picture.at({1.75, -0.75}) == 1);
  CHECK(picture.at({0, 0.25}) == Approx(0.5));  // between the last column and the first
  CHECK(picture.mean() == 0.4375);
  CHECK((AlphaPicture{2, 2, {}}.at({0.5, 0.5}) == 1 && AlphaPicture{2, 2, {}}.mean() == 1));
}

}  // namespace pprt::gltf_extensions_test
