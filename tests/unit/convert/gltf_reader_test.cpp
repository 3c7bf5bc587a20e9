// What glTF says, as scenes have it, and what is told of the rest.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "convert/gltf/gltf_holes.h"
#include "convert/model/display_values.h"
#include "convert/model/model_losses.h"
#include "image/image_io.h"
#include "scene/movement/movement.h"
#include "unit/convert/gltf_sample.h"

namespace pprt::gltf_reader_test {

namespace {

using nlohmann::json;
using Notes = std::vector<std::string>;

bool tells(const ReadMesh& read, const std::string& note) {
  return std::find(read.notes.begin(), read.notes.end(), note) != read.notes.end();
}

const Material& material_of(const ReadMesh& read) {
  const SceneDescription& scene = read.scene;
  REQUIRE(scene.primitive_count() > 0);
  return scene.materials[material_of(scene, scene.order[0])];
}

json colored(std::vector<double> factor, json more = json::object()) {
  more["pbrMetallicRoughness"] = {{"baseColorFactor", factor}, {"metallicFactor", 0}};
  return more;
}

Image stripes(int width, int height) {
  Image image(width, height);
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y)
      image.at(x, y) = Color(static_cast<float>(x) / 255, static_cast<float>(y) / 255, 0);
  }
  return image;
}

}  // namespace

TEST_CASE("gltf: a linear factor and a texture of the same grey are alike") {
  CHECK(display_value(0.5) == Approx(187.5 / 255).epsilon(0.002));
  for (const double v : {0.0, 0.001, 0.2, 0.7, 1.0})
    CHECK(light_of(display_value(v)) == Approx(v).margin(1e-12));
  GltfSample sample;
  sample.triangle_of(colored({0.5, 0.2, 0, 1}));
  const Material m = material_of(sample.read());
  CHECK(m.color.x == Approx(display_value(0.5)));
  CHECK(m.color.y == Approx(display_value(0.2)));
  CHECK(m.color.z == 0);
}

TEST_CASE("gltf: lights differ by their intensities, and the sun is one") {
  GltfSample sample;
  sample.node({{"mesh", sample.triangle()}});
  const double x = 0.5, y = 0.5;  // the middle
  sample.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 400}, {"color", {1, 0, 0}}},
      {{"type", "spot"}, {"intensity", 1}, {"spot", {{"outerConeAngle", 0.2}}}},
      {{"type", "directional"}, {"intensity", 25}}};
  for (int i = 0; i < 3; ++i)
    sample.node({{"translation", {x, y, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const ReadMesh read = sample.read();
  REQUIRE(read.scene.lights.size() == 3);
  const std::vector<Light>& lights = read.scene.lights;
  CHECK(lights[0].color.value() == Rgb(1, 0, 0));  // 400 / 2^2 is the most
  CHECK(lights[1].color.value().x == Approx(display_value(0.25 / 100)));
  CHECK(lights[2].color.value().y == Approx(display_value(25.0 / 100)));
  CHECK(lights[0].position == Vec3d(x, y, 2));
  CHECK((lights[2].is_sun && lights[2].position == Vec3d(0, 0, 1) && !lights[1].is_sun));
  CHECK(read.scene.ambient == Rgb(1, 1, 1));
  CHECK(read.notes == Notes{"1 spot light: it shines to all sides",
                            "2 lights that weaken with the distance: they are as bright everywhere as in the "
                            "middle of the scene"});
}

TEST_CASE("gltf: alpha counts as its mode says") {
  const auto read = [](const char* mode, double alpha) {
    GltfSample sample;
    sample.triangle_of(colored({1, 1, 1, alpha}, {{"alphaMode", mode}}));
    sample.node({{"mesh", sample.triangle()}});
    return sample.read();
  };
  CHECK(read("MASK", 0.4).scene.primitive_count() == 1);
  CHECK(read("MASK", 0.6).scene.primitive_count() == 2);
  CHECK(material_of(read("OPAQUE", 0.25)).transmittance == 0);
  const Material blended = material_of(read("BLEND", 0.25));
  CHECK((blended.transmittance == 0.75 && blended.refractive_index == 1 && blended.color.x == 0.25));
}

TEST_CASE("gltf: a picture's alpha cuts holes, lets through, or counts for nothing") {
  const auto read = [](const char* mode) {
    GltfSample sample;
    const json texture = {{"index", sample.half_transparent()}};
    sample.triangle_of({{"alphaMode", mode},
                        {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", texture}}}});
    return sample.read();
  };
  const auto area = [](const ReadMesh& mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.scene.triangles) {
      const auto corners = corners_of(mesh.scene, t);
      sum += (corners[1].position - corners[0].position)
                 .cross(corners[2].position - corners[0].position)
                 .length() /
             2;
    }
    return sum;
  };
  // Texels' middles lie at 1/8, 3/8, 5/8 and 7/8: alpha is half of all at 1/2, and at 0, where the picture
  // repeats. To the right of 1/2 lies a triangle with the sides 1/2.
  const ReadMesh masked = read("MASK");
  CHECK(area(masked) == Approx(0.125).epsilon(0.02));
  CHECK(masked.notes.empty());
  for (const TriangleMesh& mesh : masked.scene.meshes) CHECK(mesh.positions.size() < 400);
  const ReadMesh opaque = read("OPAQUE");
  CHECK(area(opaque) == Approx(0.5));
  CHECK(opaque.scene.textures[0].rgb[0] == 255);  // not darkened by its alpha
  const ReadMesh blended = read("BLEND");
  CHECK(material_of(blended).transmittance == Approx(0.5));
  CHECK(blended.notes == Notes{"1 material as transparent as a picture's alpha (BLEND): its mean counts"});
}

TEST_CASE("gltf: colours at vertices are shown where they are, and between") {
  GltfSample sample;
  const std::vector<float> colors = {1, 0, 0, 0, 0.5F, 0, 0, 0, 1};
  json primitive;
  primitive["attributes"]["COLOR_0"] = sample.numbers(colors, "VEC3");
  primitive["material"] = sample.add("materials", colored({0.5, 0.5, 0.5, 1}));
  sample.node({{"mesh", sample.triangle(primitive)}});
  const ReadMesh read = sample.read();
  CHECK(read.notes.empty());
  REQUIRE(read.scene.textures.size() == 1);
  const Texture& texture = read.scene.textures[0];
  const TriangleMesh& mesh = read.scene.meshes[0];
  const auto texel = [&](const Vec2d& place, std::size_t channel) {
    const double x = place.x * texture.width - 0.5, y = place.y * texture.height - 0.5;
    CHECK((std::abs(x - std::round(x)) < 1e-9 && std::abs(y - std::round(y)) < 1e-9));
    const auto at = static_cast<std::size_t>(std::lround(y) * texture.width + std::lround(x));
    return static_cast<int>(texture.rgb[3 * at + channel]);
  };
  REQUIRE(mesh.texture_points.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(texel(mesh.texture_points[i], c) ==
            std::lround(255 * display_value(static_cast<double>(colors[3 * i + c]))));
  }
  // A third of the way from the first to the second corner.
  const Vec2d between = mesh.texture_points[0] + (mesh.texture_points[1] - mesh.texture_points[0]) / 3.0;
  CHECK(texel(between, 0) == 170);
  CHECK(texel(between, 1) == std::lround(85 * display_value(0.5)));
  CHECK(material_of(read).color.x == Approx(display_value(0.5)));
}

TEST_CASE("gltf: holes of single texels are cut, wherever corners lie between them") {
  AlphaPicture checks{4, 4, {}};
  for (int i = 0; i < 16; ++i) checks.alpha.push_back((i + i / 4) % 2 == 0 ? 1.0F : 0.0F);
  ModelMesh square;
  square.texture_points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const Vec2d& p : square.texture_points) square.positions.emplace_back(p.x, p.y, 0);
  square.corners = {0, 1, 2, 0, 2, 3}, square.ends = {3, 6};
  REQUIRE(cut_holes(square, checks, 0.5));
  double area = 0;
  for (std::size_t i = 0; i < square.corners.size(); i += 3) {
    const Vec3d& a = square.positions[square.corners[i]];
    area +=
        (square.positions[square.corners[i + 1]] - a).cross(square.positions[square.corners[i + 2]] - a).z /
        2;
  }
  CHECK(area == Approx(0.5).epsilon(0.05));
}

TEST_CASE(
    "gltf: holes leave what they do not meet as it is, and the edges of too many are told to be coarse") {
  const auto cut = [](int width, const std::vector<int>& holes) {
    AlphaPicture picture{width, 1, std::vector<float>(static_cast<std::size_t>(width), 1.0F)};
    for (const int hole : holes) picture.alpha[static_cast<std::size_t>(hole)] = 0;
    ModelMesh square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.texture_points = {{0, 0}, {1, 0}, {1, 0}, {0, 0}};
    square.corners = {0, 1, 2, 0, 2, 3}, square.ends = {3, 6};
    const bool is_fine = cut_holes(square, picture, 0.5);
    return std::pair(is_fine, square.corners.size());
  };
  CHECK(cut(100, {}) == std::pair(true, std::size_t{6}));
  CHECK(cut(2, {0, 1}) == std::pair(true, std::size_t{0}));
  const auto [is_fine, corners] = cut(100, {50});
  CHECK((is_fine && corners > 6));
  CHECK_FALSE(cut(4000, {1777}).first);  // a triangle is halved nine times
}

TEST_CASE("gltf: what glows is bright without light, and unlit shows its colour") {
  GltfSample sample;
  sample.triangle_of(colored({0, 0, 0, 1}, {{"emissiveFactor", {1, 0.5, 0}}}));
  const Material lamp = material_of(sample.read());
  CHECK(lamp.emission.x == 1);
  CHECK(lamp.emission.y == Approx(display_value(0.5)));
  CHECK((lamp.emission.z == 0 && lamp.color == Rgb(0, 0, 0)));
  GltfSample unlit;
  unlit.triangle_of(colored({0, 1, 0, 1}, {{"extensions", {{"KHR_materials_unlit", json::object()}}}}));
  const Material flat = material_of(unlit.read());
  REQUIRE(flat.terms);
  CHECK((flat.terms->ambient == Rgb(0, 1, 0) && flat.terms->diffuse == Rgb(0, 0, 0)));
}

TEST_CASE("gltf: a picture glows as its own, beside that of the colour or alone, as strong as it is told") {
  GltfSample sample;
  write_image(sample.folder() / "color.png", stripes(2, 2));
  write_image(sample.folder() / "glow.png", stripes(4, 4));
  const int color = sample.texture("color.png"), glow = sample.texture("glow.png");
  json lamp = {{"emissiveFactor", {1, 0.5, 0}},
               {"emissiveTexture", {{"index", glow}}},
               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}};
  sample.triangle_of(lamp);
  lamp["pbrMetallicRoughness"]["baseColorTexture"]["index"] = color;
  sample.triangle_of(lamp);
  const ReadMesh read = sample.read();
  CHECK(read.notes.empty());
  const auto of = [&](std::size_t i) {
    return read.scene.materials[material_of(read.scene, read.scene.order.at(i))];
  };
  const auto width = [&](const std::optional<TextureIndex>& texture) {
    return read.scene.textures.at(texture.value()).width;
  };
  CHECK((!of(0).texture && width(of(0).emission_texture) == 4));
  CHECK((width(of(1).texture) == 2 && width(of(1).emission_texture) == 4));
  CHECK(of(1).emission.x == Approx(unbounded_display_value(4)));
  CHECK(unbounded_display_value(4) == Approx(1.055 * std::pow(4, 1 / 2.4) - 0.055));
  CHECK(of(1).emission.y == Approx(unbounded_display_value(2)));
  CHECK(read.scene.meshes.at(0).texture_points.at(1) == Vec2d(1, 0));
}

TEST_CASE("gltf: glass has its index, and metal mirrors as far as it is smooth") {
  GltfSample glass;
  glass.triangle_of(colored({1, 1, 1, 1}, {{"extensions",
                                            {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}},
                                             {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                                             {"KHR_materials_ior", {{"ior", 1.3}}}}}}));
  const Material m = material_of(glass.read());
  CHECK((m.transmittance == 0.75 && m.refractive_index == 1.3 && m.color.x == 0.25));
  GltfSample metal;
  metal.triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0.5}}}});
  const Material mirror = material_of(metal.read());
  CHECK((mirror.specular == 0.5 && mirror.color.x == 0.5 && mirror.shine == Approx(30)));
}

TEST_CASE("gltf: textures are turned, shrunk and moved, and continue as their sampler says") {
  const auto read = [](const json& transform, const json& sampler) {
    GltfSample sample;
    write_image(sample.folder() / "t.png", stripes(4, 2));
    json texture = {{"index", sample.texture("t.png", sampler)}};
    if (!transform.empty()) texture["extensions"]["KHR_texture_transform"] = transform;
    sample.triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", texture}}}});
    ReadMesh result = sample.read();
    CHECK(result.notes.empty());
    REQUIRE(result.scene.meshes.size() == 1);
    return result;
  };
  // Corners (0 0) (1 0) (0 1).
  const auto points = [](const ReadMesh& mesh) { return mesh.scene.meshes[0].texture_points; };
  CHECK(points(read({}, {})) == std::vector<Vec2d>{{0, 0}, {1, 0}, {0, 1}});
  CHECK(points(read({{"offset", {0.5, 0}}, {"scale", {0.5, 0.25}}}, {})) ==
        std::vector<Vec2d>{{0.5, 0}, {1, 0}, {0.5, 0.25}});
  // A quarter turn against the clock, as the picture is seen: to the right becomes up, which is less of v.
  const std::vector<Vec2d> turned = points(read({{"rotation", M_PI / 2}}, {}));
  CHECK((turned[1] - Vec2d(0, -1)).length() < 1e-9);
  CHECK((turned[2] - Vec2d(1, 0)).length() < 1e-9);

  const ReadMesh mirrored = read({{"scale", {2, 2}}}, {{"wrapS", 33648}, {"wrapT", 10497}});
  const Texture& twice = mirrored.scene.textures[0];
  CHECK((twice.width == 8 && twice.height == 2));
  std::vector<int> reds;
  for (std::size_t i = 0; i < 8; ++i) reds.push_back(twice.rgb[3 * i]);
  CHECK(reds == std::vector<int>{0, 1, 2, 3, 3, 2, 1, 0});
  CHECK(points(mirrored) == std::vector<Vec2d>{{0, 0}, {1, 0}, {0, 2}});

  const ReadMesh clamped =
      read({{"scale", {2, 1}}, {"offset", {-1, 0}}}, {{"wrapS", 33071}, {"wrapT", 33071}});
  const Texture& wide = clamped.scene.textures[0];
  reds.clear();
  for (std::size_t i = 0; i < 8; ++i) reds.push_back(wide.rgb[3 * i]);
  CHECK(reds == std::vector<int>{0, 0, 0, 0, 0, 1, 2, 3});
  CHECK(points(clamped) == std::vector<Vec2d>{{0, 0}, {1, 0}, {0, 1}});
}

TEST_CASE("gltf: sparse, strided and whole numbers, strips and mirrored nodes are read") {
  GltfSample sample;
  const std::int16_t half_of_all[] = {0, 0, 0, 32767, 0, 0, 0, 32767, 0};
  const int corners =
      sample.accessor({reinterpret_cast<const char*>(half_of_all), sizeof half_of_all},
                      {{"componentType", 5122}, {"count", 3}, {"type", "VEC3"}, {"normalized", true}});
  sample.node({{"mesh", sample.triangle({{"attributes", {{"POSITION", corners}}}})}, {"scale", {-1, 1, 1}}});
  const float moved[] = {5, 6, 7};
  json sparse = {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}};
  sparse["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", sample.view(std::string("\x03", 1))}, {"componentType", 5121}}},
      {"values", {{"bufferView", sample.view({reinterpret_cast<const char*>(moved), 12})}}}};
  const int strip = sample.accessor(std::string(48, '\0'), sparse);
  sample.node({{"mesh", sample.triangle({{"mode", 5}, {"attributes", {{"POSITION", strip}}}})}});
  const ReadMesh read = sample.read();
  REQUIRE(read.scene.polygons.size() == 1);
  const auto vertices = read.scene.vertices(read.scene.polygons[0]);
  // Mirrored, but its front stays its front: the corners run the other way.
  CHECK(vertices[0] == Vec3d(0, 1, 0));
  CHECK(vertices[1] == Vec3d(-1, 0, 0));
  CHECK(read.notes == Notes{"2 points, lines and faces without extent left out"});
}

TEST_CASE("gltf: whole numbers without a sign reach as far as their bits") {
  const std::uint16_t wide[] = {0, 0, 0, 65535, 0, 0, 0, 40000, 0};
  for (const bool normalized : {false, true}) {
    GltfSample sample;
    const int corners = sample.accessor(
        {reinterpret_cast<const char*>(wide), sizeof wide},
        {{"componentType", 5123}, {"count", 3}, {"type", "VEC3"}, {"normalized", normalized}});
    sample.node({{"mesh", sample.triangle({{"attributes", {{"POSITION", corners}}}})}});
    const ReadMesh read = sample.read();
    REQUIRE(read.scene.polygons.size() == 1);
    const auto vertices = read.scene.vertices(read.scene.polygons[0]);
    const double unit = normalized ? 65535 : 1;
    CHECK(vertices[1].x == Approx(65535 / unit));
    CHECK(vertices[2].y == Approx(40000 / unit));
  }
}

TEST_CASE("gltf: all triangles of strips and fans show the side of the first") {
  // A zigzag, and the corners of a pentagon around the first.
  const std::vector<float> zigzag = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0},
                           pentagon = {0, 0, 0, 1, 0, 0, 2, 1, 0, 1, 2, 0, 0, 2, 0};
  for (const int mode : {5, 6}) {
    GltfSample sample;
    const int corners = sample.numbers(mode == 5 ? zigzag : pentagon, "VEC3");
    sample.node({{"mesh", sample.triangle({{"mode", mode}, {"attributes", {{"POSITION", corners}}}})}});
    const ReadMesh read = sample.read();
    REQUIRE(read.scene.polygons.size() == 3);
    double area = 0;
    for (const Polygon& polygon : read.scene.polygons) {
      const auto v = read.scene.vertices(polygon);
      const Vec3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
      CHECK(normal.z > 0);
      area += 0.5 * normal.z;
    }
    CHECK(area == Approx(mode == 5 ? 1.5 : 0.5 + 1.5 + 1));
  }
}

TEST_CASE("gltf: what is hidden is left out, unless it appears") {
  const json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
  GltfSample sample;
  const int mesh = sample.triangle();
  sample.node({{"mesh", mesh}});
  sample.node({{"mesh", mesh}, {"extensions", hidden}});
  sample.node({{"name", "ghost"}, {"mesh", mesh}, {"extensions", hidden}});
  const std::string pointer = "/nodes/2/extensions/KHR_node_visibility/visible";
  sample.document["animations"] = {
      {{"samplers",
        {{{"input", sample.numbers({0, 1}, "SCALAR")},
          {"output", sample.accessor(std::string("\0\1", 2),
                                     {{"componentType", 5121}, {"count", 2}, {"type", "SCALAR"}})},
          {"interpolation", "STEP"}}}},
       {"channels",
        {{{"sampler", 0},
          {"target",
           {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}}}}}};
  const ReadMesh read = sample.read();
  CHECK(read.notes.empty());
  CHECK(read.scene.primitive_count() == 2);
  CHECK_FALSE(track_at(read.scene.movement, "ghost", 0.5)->visible);
  CHECK(track_at(read.scene.movement, "ghost", 1)->visible);
}

TEST_CASE("gltf: a movement of what the scene does not have is left out") {
  GltfSample sample;
  sample.node({{"mesh", sample.triangle()}});
  const int elsewhere = sample.add("nodes", {{"name", "elsewhere"}, {"mesh", 0}});
  sample.move(elsewhere, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  const Movement alone = sample.read().scene.movement;
  CHECK((alone.tracks.empty() && !alone.times));
  const int shown = sample.node({{"name", "shown"}, {"mesh", 0}});
  sample.move(shown, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  const Movement both = sample.read().scene.movement;
  CHECK((both.tracks.size() == 1 && both.tracks.contains("shown") && both.times));
}

TEST_CASE("gltf: every loss is told") {
  GltfSample sample;
  write_image(sample.folder() / "t.png", stripes(2, 2));
  const int plain = sample.texture("t.png"), hard = sample.texture("t.png", {{"magFilter", 9728}}),
            border = sample.texture("t.png", {{"wrapS", 33071}, {"wrapT", 33071}});
  const auto pictured = [](int texture, json more) {
    more["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", texture}}}, {"metallicFactor", 0}};
    return more;
  };
  const int half = sample.half_transparent(), half_hard = sample.half_transparent({{"magFilter", 9728}});
  json cut = pictured(half, {{"alphaMode", "MASK"}, {"normalTexture", {{"index", plain}}}});
  cut["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {1e7,
                                                                                                     1e7};
  sample.triangle_of(cut);
  sample.triangle_of(pictured(half_hard, {{"alphaMode", "BLEND"}, {"occlusionTexture", {{"index", plain}}}}));
  json glowing = pictured(
      plain, {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", hard}, {"texCoord", 1}}}});
  glowing["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = plain;
  sample.triangle_of(glowing);
  json far = pictured(border, json::object());
  far["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {99, 99};
  sample.triangle_of(far);
  sample.triangle_of(
      {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}, {"roughnessFactor", 0}}}});
  const json pattern = {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}};
  sample.triangle_of({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                      {"extensions", {{"KHR_materials_transmission", pattern}}}});
  sample.triangle_of(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}}, {"doubleSided", false}});
  const int colors = sample.numbers({1, 0, 0, 1, 0, 0, 0.25F, 0, 0}, "VEC3");
  const int shapes = sample.numbers({0, 0, 0, 0, 0, 0, 0, 0, 1}, "VEC3");
  json coloured;
  coloured["material"] = 0;
  coloured["attributes"]["COLOR_0"] = colors;
  coloured["targets"].push_back({{"POSITION", shapes}});
  sample.node({{"mesh", sample.triangle(coloured)}, {"skin", 0}});
  sample.document["skins"].push_back({{"joints", {0}}});
  sample.document["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 1}, {"zfar", 9}}}}};
  for (const int camera : {1, 0, 0}) sample.node({{"camera", camera}, {"translation", {0, 0, 5}}});
  sample.document["scenes"].push_back(json::object());
  sample.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", json::object()}}};
  sample.node({{"translation", {0, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  sample.document["extensionsUsed"] = {"KHR_materials_clearcoat"};
  const int times = sample.numbers({0, 1}, "SCALAR");
  json animation = {{"samplers", {{{"input", times}, {"output", times}}}}};
  animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
                           {{"sampler", 0}, {"target", {{"path", "pointer"}}}}};
  sample.document["animations"].push_back(animation);
  const ReadMesh read = sample.read();
  const auto of_gltf = std::span(kModelLossWords).first(static_cast<std::size_t>(ModelLoss::kOtherPictures));
  for (const auto& [one, many] : of_gltf) {
    CAPTURE(many);
    CHECK(
        std::any_of(read.notes.begin(), read.notes.end(), [one = one, many = many](const std::string& note) {
          return note == counted(1, one, many) || (note.ends_with(many) && !note.starts_with("1 "));
        }));
  }
  CHECK(tells(read, "1 camera besides the first: left out"));  // the one without perspective counts by itself
  CHECK(tells(read, "the extension KHR_materials_clearcoat is not known: what it adds is left out"));
  CHECK(std::set<std::string>(read.notes.begin(), read.notes.end()).size() == read.notes.size());
  const Material red = read.scene.materials[material_of(read.scene, read.scene.order.back())];
  CHECK(red.color.x == Approx(display_value(0.75)));
  CHECK(red.color.y == 0);
}

TEST_CASE("gltf: numbers that are not there, and packed ones, are refused") {
  const auto report = [](const GltfSample& sample) -> std::string {
    try {
      sample.read();
      return "read";
    } catch (const InputError& e) {
      const std::string text = e.what();
      return text.substr(text.find("error: ") + 7);
    }
  };
  GltfSample sample;
  sample.node({{"mesh", sample.triangle()}});
  CHECK(report(sample) == "read");
  const auto with = [&](const char* place, const json& value) {
    GltfSample other;
    other.node({{"mesh", other.triangle()}});
    other.document[json::json_pointer(place)] = value;
    return report(other);
  };
  CHECK(with("/accessors/0/count", 1000) == "it has numbers beyond the end of their buffer");
  CHECK(with("/accessors/0/bufferView", 99) == "it names a part of a buffer that is not there");
  const json no_data = {{"componentType", 5126}, {"count", 4294967295U}, {"type", "VEC3"}};
  CHECK(with("/accessors/0", no_data) == "it has too many numbers without data");
  CHECK(with("/bufferViews/0/byteLength", 4000) == "a part of a buffer lies beyond its end");
  CHECK(with("/nodes/0/mesh", 7) == "it names a mesh that is not there");
  CHECK(with("/meshes/0/primitives/0/material", 7) == "it names a material that is not there");
  CHECK(with("/meshes/0/primitives/0/attributes/POSITION", 1) ==
        "a mesh has positions or normals that are no vectors");
  CHECK(with("/extensionsRequired", {"KHR_draco_mesh_compression"}) ==
        "its numbers are packed (KHR_draco_mesh_compression), which cannot be read; export it without");
}

}  // namespace pprt::gltf_reader_test
