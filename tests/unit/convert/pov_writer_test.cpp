#include "convert/pov/pov_writer.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <tuple>

#include "base/diagnostics.h"
#include "convert/pov/pov_material.h"

namespace pprt::pov_writer_test {

namespace {

std::string pov(const SceneDescription& scene) {
  std::ostringstream out;
  write_pov(scene, out);
  return out.str();
}

// What follows the materials.
std::string objects(const SceneDescription& scene) {
  const std::string text = pov(scene);
  const std::size_t last = text.rfind("#declare Material_");
  return text.substr(text.find("\n}\n", last) + 3);
}

// Seen from 40000 away, so that lengths are written as they are; the first material matte, the second of
// glass.
SceneDescription two_materials() {
  SceneDescription scene;
  scene.view = View{{0, 0, 40000}, {0, 0, 0}, {0, 1, 0}, 90, 0, 640, 3, {}};
  scene.materials = {{}, {Rgb(0.5, 0.25, 1), 0.125, 0.5, 30, 0.75, 1.5}};
  return scene;
}

// A white material for a colour of each term, in a scene with an ambient light.
SceneDescription with_terms(const TermColors& terms, const Rgb& ambient) {
  SceneDescription scene = two_materials();
  scene.ambient = ambient;
  scene.lights = {{{1, 2, 3}, Rgb(0.5, 1, 0.25), {}}, {{4, 5, 6}, {}, {}}};
  scene.materials = {{}};
  scene.materials[0].terms = terms;
  scene.materials[0].specular = std::max({terms.specular.x, terms.specular.y, terms.specular.z});
  scene.materials[0].shine = 8;
  return scene;
}

// A triangle that shows a texture of 1 x 2 texels, red above blue.
SceneDescription textured() {
  SceneDescription scene = with_terms({{0.25, 0.25, 0.25}, {0.5, 0.5, 0.5}, {0, 0, 0}}, Rgb(2, 1, 1));
  scene.textures = {{"red \"blue\".ppm", 1, 2, {255, 1, 2, 3, 4, 255}}};
  scene.materials[0].texture = TextureIndex{0};
  const TriangleCorners corners{.position = {0, 1, 2}, .normal = {}, .texture_point = {2, 1, 0}};
  add_mesh(scene,
           {.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
            .normals = {},
            .texture_points = {{0, 0}, {2, 0.25}, {-1, 3}},
            .material = 0},
           {&corners, 1});
  return scene;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a whole scene is written in POV-Ray's language") {
  SceneDescription scene = two_materials();
  scene.background = Rgb(0.078, 0.361, 0.753);
  scene.lights = {
      {{-5, 5, 50}, {}, {}}, {{1, 2, 3}, Rgb(1, 0.5, 0), {}}, {{4, 5, 6}, {}, {}}, {{7, 8, 9}, {}, {}}};
  const Vec3d triangle[] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const PatchVertex patch[] = {{{0, 0, 0}, {0, 0, 8}}, {{1, 0, 0}, {0, 0, 0}}, {{0, 1, 0}, {4, 0, 0}}};
  add_polygon(scene, triangle, 0);
  add_patch(scene, patch, 0);
  add_cone(scene, {{1, 2, 3}, 0.5, {4, 5, 6}, 0.25, 0, {}});
  add_cone(scene, {{1, 2, 3}, 0.5, {4, 5, 6}, 0.5, 0, {}});
  add_sphere(scene, {{7, 8, 9}, 2, 1, {}});
  CHECK(pov(scene) == R"(// Lengths are 1 times the scene's, as POV-Ray ignores hits nearer than 0.001.
//   povray +I... +W640 +H3 -A
#version 3.7;
global_settings { assumed_gamma srgb max_trace_level 5 adc_bailout 0 ambient_light rgb 1 }
background { rgb <0.078, 0.361, 0.753> }

#declare Pixel = 1.9999999999999998 / max(image_height - 1, 1);
camera {
  perspective
  location <0, 0, 40000>
  direction <0, 0, -1>
  right <1, -0, 0> * Pixel * image_width
  up <0, 1, 0> * Pixel * image_height
}

light_source { <-5, 5, 50> rgb <0.25, 0.25, 0.25> }
light_source { <1, 2, 3> rgb <0.25, 0.125, 0> }
light_source { <4, 5, 6> rgb <0.25, 0.25, 0.25> }
light_source { <7, 8, 9> rgb <0.25, 0.25, 0.25> }

#declare Material_1 = texture {
  pigment { rgb <1, 1, 1> }
  finish { ambient 0.025 diffuse 1 }
}
#declare Material_2 = texture {
  pigment { rgb <0.5, 0.25, 1> transmit 0.75 }
  finish { ambient 0.1 diffuse 0.5 phong 0.5 phong_size 30 reflection 0.5 }
}
mesh {
  triangle { <0, 0, 0>, <4, 0, 0>, <0, 4, 0> }
  smooth_triangle { <0, 0, 0>, <0, 0, 1>, <1, 0, 0>, <0, 0, 1>, <0, 1, 0>, <1, 0, 0> } texture { Material_1 } }
cone { <1, 2, 3>, 0.5, <4, 5, 6>, 0.25 open texture { Material_1 } }
cylinder { <1, 2, 3>, <4, 5, 6>, 0.5 open texture { Material_1 } }
#declare Glass = sphere { <7, 8, 9>, 2 }
object { Glass texture { Material_2 } interior { ior 1.5 } no_shadow }
object { Glass no_image no_reflection }
)");
}

TEST_CASE(
    "lengths are scaled by a power of two, so that POV-Ray's least distance is as small as a rounding") {
  SceneDescription scene = two_materials();
  scene.view->from = {0, 0, 3};
  scene.view->angle_degrees = 45;
  scene.lights = {{{100, 0, 0}, {}, {}}};
  add_sphere(scene, {{0, 0, 0}, 1.25, 0, {}});
  const std::string text = pov(scene);
  CHECK(text.find("// Lengths are 8192 times") == 0);
  CHECK(text.find("location <0, 0, 24576>") != std::string::npos);
  CHECK(text.find("light_source { <819200, 0, 0>") != std::string::npos);
  CHECK(objects(scene) == "sphere { <0, 0, 0>, 10240 texture { Material_1 } }\n");
}

TEST_CASE(
    "for POV-Ray adjacent polygons of one material are one mesh, and glass is one body with an interior") {
  SceneDescription scene = two_materials();
  const Vec3d triangle[] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  add_polygon(scene, triangle, 1);
  add_polygon(scene, triangle, 1);
  add_polygon(scene, triangle, 0);
  CHECK(objects(scene) == R"(#declare Glass = mesh {
  triangle { <0, 0, 0>, <4, 0, 0>, <0, 4, 0> }
  triangle { <0, 0, 0>, <4, 0, 0>, <0, 4, 0> } }
object { Glass texture { Material_2 } interior { ior 1.5 } no_shadow }
object { Glass no_image no_reflection }
mesh {
  triangle { <0, 0, 0>, <4, 0, 0>, <0, 4, 0> } texture { Material_1 } }
)");
}

TEST_CASE("for POV-Ray a concave polygon becomes triangles that leave its notch open") {
  SceneDescription scene = two_materials();
  const Vec3d arrow[] = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
  add_polygon(scene, arrow, 0);
  const std::string text = objects(scene);
  CHECK(text.find("<4, 0, 0>, <1, 1, 0>") != std::string::npos);
  CHECK(text.find("<1, 1, 0>, <0, 4, 0>") != std::string::npos);
}

TEST_CASE("for POV-Ray a fully transparent surface keeps a share that is lit") {
  SceneDescription scene = two_materials();
  scene.materials[1].transmittance = 1;
  scene.materials[1].diffuse = 0.5;
  const std::string text = pov(scene);
  CHECK(text.find("transmit 0.9990234375 }") != std::string::npos);
  CHECK(text.find("diffuse 512 ") != std::string::npos);
}

TEST_CASE("for POV-Ray degenerate objects are left out and one-sided ones are counted") {
  SceneDescription scene = two_materials();
  const Vec3d line[] = {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}};
  add_sphere(scene, {{0, 0, 0}, 0, 0, {}});
  add_cone(scene, {{1, 1, 1}, 1, {1, 1, 1}, 2, 0, {}});
  add_polygon(scene, line, 0);
  add_sphere(scene, {{0, 0, 0}, -2, 0, {}});
  std::ostringstream out;
  const PovLosses losses = write_pov(scene, out);
  CHECK(losses.degenerate == 3);
  CHECK(losses.one_sided == 1);
  CHECK(objects(scene) == "sphere { <0, 0, 0>, 2 texture { Material_1 } }\n");
}

TEST_CASE("for POV-Ray a cone is one-sided if either of its radii is negative") {
  for (const auto& [base, apex, is_one_sided] :
       {std::tuple(-1.0, -2.0, true), {0.0, -2.0, true}, {-1.0, 0.0, true}, {1.0, 2.0, false}}) {
    SceneDescription scene = two_materials();
    add_cone(scene, {{0, 0, 0}, base, {0, 0, 3}, apex, 0, {}});
    std::ostringstream out;
    CHECK(write_pov(scene, out).one_sided == (is_one_sided ? 1U : 0U));
  }
}

TEST_CASE("a scene without a view or with a degenerate one cannot be written for POV-Ray") {
  SceneDescription scene = two_materials();
  scene.name = "a.nff";
  scene.view->up = {0, 0, 1};
  CHECK_THROWS_WITH(pov(scene), "a.nff: error: view: 'up' is zero or parallel to the direction of view");
  scene.view.reset();
  CHECK_THROWS_WITH(pov(scene), "a.nff: error: the scene has no view");
}

TEST_CASE("for POV-Ray lights count as written where the scene has an ambient light") {
  SceneDescription scene = with_terms({}, Rgb(1, 1, 1));
  CHECK(contains(pov(scene), "light_source { <1, 2, 3> rgb <0.5, 1, 0.25> }"));
  scene.ambient.reset();
  CHECK_FALSE(contains(pov(scene), "light_source { <1, 2, 3> rgb <0.5, 1, 0.25> }"));
}

TEST_CASE("for POV-Ray pigment times finish gives the colour of each term") {
  const SceneDescription scene =
      with_terms({{0.5, 0.25, 0.5}, {0.25, 0.5, 0.125}, {0.5, 0.5, 0.5}}, Rgb(1, 2, 0.5));
  const std::string text = pov(scene);
  CHECK(contains(text, "pigment { rgb <0.5, 1, 0.25> }"));
  CHECK(
      contains(text, "finish { ambient rgb <1, 0.5, 1> diffuse 0.5 phong 0.5 phong_size 8 reflection 0.5 }"));
}

TEST_CASE("for POV-Ray a channel that reflects ambient light alone keeps it") {
  const SceneDescription scene = with_terms({{0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0}}, Rgb(1, 1, 1));
  const PovMaterial m = pov_material(scene, scene.materials[0]);
  CHECK(m.pigment.x * m.diffuse < 1e-6);
  CHECK(m.pigment.x * m.ambient.x == Approx(0.5));
  CHECK((m.pigment.z == 0 && m.ambient.z == 0));
  CHECK_FALSE(m.lost_ambient);
  const SceneDescription dark = with_terms({{0.5, 0.25, 0}, {0, 0, 0}, {0, 0, 0}}, Rgb(1, 1, 2));
  CHECK(contains(pov(dark), "pigment { rgb <1, 1, 1> }\n  finish { ambient rgb <0.5, 0.25, 0> diffuse 0 }"));
}

TEST_CASE("for POV-Ray a coloured highlight is white under a layer that colours it") {
  const SceneDescription scene = with_terms({{0.5, 0, 0}, {0.5, 0.25, 0}, {0.5, 0.25, 0.5}}, Rgb(1, 1, 1));
  CHECK(contains(pov(scene), R"(#declare Material_1 = texture {
  pigment { rgb <1, 1, 0> }
  finish { ambient rgb <0.5, 0, 0> diffuse 0.5 phong 0.5 phong_size 8 reflection rgb <0.5, 0.25, 0.5> }
}
texture {
  pigment { rgb <1, 0.5, 1> filter 1 }
  finish { ambient 0 diffuse 0 }
}
)"));
  const SceneDescription grey = with_terms({{0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}}, Rgb(1, 1, 1));
  CHECK_FALSE(contains(pov(grey), "filter"));
}

TEST_CASE("for POV-Ray a coloured highlight on glass or on a texture becomes white and is counted") {
  SceneDescription scene = with_terms({{0, 0, 0}, {1, 1, 1}, {0.75, 0.5, 0.25}}, Rgb(1, 1, 1));
  std::ostringstream out;
  CHECK(write_pov(scene, out).lost_highlights == 0);
  scene.materials[0].transmittance = 0.5;
  CHECK(write_pov(scene, out).lost_highlights == 1);
  CHECK(contains(out.str(), "phong 0.5 phong_size 8 reflection rgb <0.75, 0.5, 0.25> }"));
  scene.materials[0].transmittance = 0;
  scene.materials[0].texture = TextureIndex{0};
  scene.textures = {{"a", 1, 1, {1, 2, 3}}};
  CHECK(write_pov(scene, out).lost_highlights == 1);
}

TEST_CASE("for POV-Ray a texture is a picture, whose v runs up") {
  const SceneDescription scene = textured();
  std::ostringstream out;
  write_pov(scene, out, "a");
  CHECK(contains(out.str(), R"(#declare Textured_1 = texture {
  pigment { uv_mapping image_map { png "a-red__blue_.png" gamma srgb interpolate 2 } }
  finish { ambient rgb <0.5, 0.25, 0.25> diffuse 0.5 }
}
mesh {
  triangle { <0, 0, 0>, <4, 0, 0>, <0, 4, 0> uv_vectors <-1, -2>, <2, 0.75>, <0, 1> } texture { Textured_1 } }
)"));
}

TEST_CASE(
    "for POV-Ray a triangle without texture points shows no texture, and ends the mesh of those that do") {
  SceneDescription scene = textured();
  const Vec3d triangle[] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  add_polygon(scene, triangle, 0);
  CHECK(contains(pov(scene), R"( texture { Textured_1 } }
mesh {
  triangle { <0, 0, 0>, <4, 0, 0>, <0, 4, 0> } texture { Material_1 } }
)"));
}

TEST_CASE("for POV-Ray a patch after a triangle with a texture shows none") {
  SceneDescription scene = textured();
  const PatchVertex patch[] = {{{0, 0, 0}, {0, 0, 1}}, {{4, 0, 0}, {0, 0, 1}}, {{0, 4, 0}, {0, 0, 1}}};
  add_patch(scene, patch, 0);
  CHECK(contains(pov(scene), R"( texture { Textured_1 } }
mesh {
  smooth_triangle { <0, 0, 0>, <0, 0, 1>, <4, 0, 0>, <0, 0, 1>, <0, 4, 0>, <0, 0, 1> } texture { Material_1 } }
)"));
}

TEST_CASE("the pictures of textures have their bytes, one for each tint, under distinct names") {
  SceneDescription scene = textured();
  scene.textures.push_back({"red \"blue\".png", 1, 1, {9, 9, 9}});
  for (int i = 0; i < 3; ++i) scene.materials.push_back(scene.materials[0]);
  scene.materials[1].terms->diffuse = {1, 0.5, 0};
  scene.materials[2].texture = TextureIndex{1};
  const PovPictures pictures = pov_pictures(scene, "a");
  REQUIRE(pictures.files.size() == 3);
  CHECK(pictures.files[0].name == "a-red__blue_.png");
  CHECK(pictures.files[1].name == "a-red__blue_-2.png");
  CHECK(pictures.files[2].name == "a-red__blue_-3.png");
  CHECK((pictures.materials[0] == std::size_t{0} && pictures.materials[3] == std::size_t{0}));
  const Image plain = picture_of(scene, pictures.files[0]);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(std::lround(255 * plain.pixels[i / 3][static_cast<int>(i % 3)]) == scene.textures[0].rgb[i]);
  const Image tinted = picture_of(scene, pictures.files[1]);
  CHECK(tinted.pixels[0].x == 1);
  CHECK(tinted.pixels[1].y == Approx(2 / 255.0));
  CHECK(tinted.pixels[1].z < 1e-5);
  std::ostringstream out;
  CHECK(write_pov(scene, out).lost_ambient == 1);  // the blue of the second material
}

TEST_CASE("for POV-Ray a stretched ball stands where lengths are scaled to") {
  SceneDescription scene = two_materials();
  scene.view->from = {0, 0, 10000};  // four times as long
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  scene.movement.nodes.push_back(
      {.parent = 0, .to_parent = {{2, 0, 0}, {0, 1, 0}, {0, 0, 3}, {5, 6, 7}}, .track = {}, .location = {}});
  scene.nodes = {1};
  CHECK(objects(scene) ==
        "sphere { <0, 0, 0>, 4 matrix <2, 0, 0, 0, 1, 0, 0, 0, 3, 20, 24, 28> texture { Material_1 } }\n");
}

TEST_CASE("for POV-Ray a stretched ball keeps the map that stretches it") {
  SceneDescription scene = two_materials();
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  scene.movement.nodes.push_back(
      {.parent = 0, .to_parent = {{2, 0, 0}, {0, 1, 0}, {0, 0, 3}, {5, 6, 7}}, .track = {}, .location = {}});
  scene.nodes = {1};
  CHECK(objects(scene) ==
        "sphere { <0, 0, 0>, 1 matrix <2, 0, 0, 0, 1, 0, 0, 0, 3, 5, 6, 7> texture { Material_1 } }\n");
}

TEST_CASE("for POV-Ray what gives off light has a layer that does, with its picture") {
  SceneDescription scene = textured();
  CHECK_FALSE(contains(pov(scene), "emission"));
  scene.materials[0].emission = {0.5, 0.25, 1};
  const std::string plain = R"(texture {
  pigment { rgb <1, 1, 1> transmit 0.9990234375 }
  finish { ambient 0 diffuse 0 emission rgb <512, 256, 1024> }
}
)";
  CHECK(contains(pov(scene), plain + "#declare Textured_1"));
  CHECK(contains(pov(scene), plain + "mesh {"));
  scene.textures.push_back({"lamp", 1, 1, {9, 9, 9}});
  scene.materials[0].emission_texture = TextureIndex{1};
  CHECK(contains(pov(scene), R"(texture {
  pigment { uv_mapping image_map { png "scene-lamp.png" gamma srgb interpolate 2 transmit all 0.9990234375 } }
  finish { ambient 0 diffuse 0 emission rgb <512, 256, 1024> }
}
mesh {)"));
  scene.materials[0].texture.reset();  // then it glows alone, at the same points
  CHECK(contains(pov(scene), "#declare Textured_1 = texture {\n  pigment { rgb <1, 1, 1> }"));
  CHECK(contains(pov(scene), "uv_vectors <-1, -2>"));
}

TEST_CASE("for POV-Ray a sun is parallel, and a sky is one") {
  SceneDescription scene = with_terms({{0, 0, 0}, {1, 1, 1}, {0, 0, 0}}, Rgb(1, 1, 1));
  add_sphere(scene, {{0, 0, 0}, 1, 0, {}});
  CHECK_FALSE(contains(pov(scene), "parallel"));
  CHECK_FALSE(contains(pov(scene), "sky_sphere"));
  scene.lights[0] = {{0, 2, 0}, Rgb(0.5, 1, 0.25), {}, true};
  scene.background = Rgb(0, 0.5, 0);
  scene.sky = Sky{.up = {0, 2, 0}, .horizon = {1, 1, 1}, .zenith = {0, 0, 1}};
  CHECK(contains(pov(scene),
                 "light_source { <0, 1e+06, 40000> rgb <0.5, 1, 0.25> parallel point_at <0, 0, 40000> }"));
  CHECK(contains(pov(scene),
                 "sky_sphere { pigment { gradient <0, 1, 0> color_map { [0 rgb <0, 0.5, 0>] [0.5 "
                 "rgb <0, 0.5, 0>] [0.5 rgb <1, 1, 1>] [1 rgb <0, 0, 1>] } scale "));
}

}  // namespace pprt::pov_writer_test
