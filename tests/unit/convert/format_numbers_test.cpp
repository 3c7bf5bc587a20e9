// Small models written by hand, and the numbers of the scenes that come of them. Nothing in them is
// symmetric: what is turned, mirrored, swapped or applied in another order has other numbers.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "convert/mesh/mesh_reader.h"
#include "scene/animation/resting_nodes.h"
#include "unit/convert/gltf_sample.h"

namespace pprt::format_numbers_test {
namespace {

using Json = nlohmann::json;

SceneDescription read(const std::vector<std::pair<std::string, std::string>>& files) {
  const TemporaryDirectory folder;
  for (const auto& [name, text] : files) std::ofstream(folder.path() / name, std::ios::binary) << text;
  return read_mesh((folder.path() / files.back().first).string()).scene;
}

void check_near(const Vec3d& a, const Vec3d& b) {
  CAPTURE(a.x, a.y, a.z, b.x, b.y, b.z);
  CHECK((a - b).length() <= 1e-5);
}

void check_near(const Rgb& a, const Rgb& b) {
  check_near(Vec3d(a.x, a.y, a.z), Vec3d(b.x, b.y, b.z));
}

// Half the picture's height at a distance of 1, by the view's angle between the centres of its rows.
double half_height(const View& view) {
  return std::tan(view.angle_degrees * std::numbers::pi / 360) * view.height / (view.height - 1);
}

// A triangle in a node that is scaled and moved, in one that is turned by 90 degrees and moved; with it a
// camera, a lamp and a sun.
std::string collada(const std::string& asset) {
  const auto light = [](const std::string& id, const std::string& kind, const std::string& color) {
    return "<light id=\"" + id + "\"><technique_common><" + kind + "><color>" + color + "</color></" + kind +
           "></technique_common></light>";
  };
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         asset + R"(</asset>
<library_cameras><camera id="c"><optics><technique_common><perspective><yfov>40</yfov>
<aspect_ratio>1.5</aspect_ratio><znear>.25</znear></perspective></technique_common></optics></camera></library_cameras>
<library_lights>)" +
         light("lamp", "point", "2 1 .5") + light("sun", "directional", "1 1 1") + R"(</library_lights>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong>
<emission><color>.125 .25 .375 1</color></emission><diffuse><color>.5 .625 .75 1</color></diffuse>
<specular><color>.25 .25 .25 1</color></specular><shininess><float>40</float></shininess>
</phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">1 2 4 3 2 4 1 5 4
</float_array><technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1" material="s">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node id="outer"><translate>10 0 0</translate><rotate>0 0 1 90</rotate>
<node id="inner"><translate>0 0 3</translate><scale>2 1 1</scale>
<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="s" target="#m"/>
</technique_common></bind_material></instance_geometry></node>
<node id="eye"><translate>0 5 0</translate><rotate>1 0 0 90</rotate><instance_camera url="#c"/></node>
<node id="at"><translate>1 2 3</translate><instance_light url="#lamp"/></node>
<node id="sky"><rotate>1 0 0 90</rotate><instance_light url="#sun"/></node></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

const Material& material_of_first(const SceneDescription& scene) {
  return scene.materials.at(material_of(scene, scene.order.at(0)));
}

}  // namespace

TEST_CASE("format numbers: COLLADA's nodes in each other, its material, camera and lights") {
  const SceneDescription scene = read({{"a.dae", collada("<up_axis>Y_UP</up_axis>")}});
  REQUIRE(scene.polygons.size() == 1);
  const std::span<const Vec3d> corners = scene.vertices(scene.polygons[0]);
  REQUIRE(corners.size() == 3);
  check_near(corners[0], {8, 2, 7});  // (1 2 4), scaled (2 2 4), moved (2 2 7), turned (-2 2 7)
  check_near(corners[1], {8, 6, 7});
  check_near(corners[2], {5, 2, 7});
  const Material& material = material_of_first(scene);
  check_near(material.color, {0.5, 0.625, 0.75});
  check_near(material.emission, {0.125, 0.25, 0.375});
  CHECK((material.specular == 0.25 && material.shine == 40 && material.transmittance == 0));
  REQUIRE(scene.view);
  check_near(scene.view->from, {5, 0, 0});                    // (0 5 0), turned
  check_near(scene.view->at - scene.view->from, {-1, 0, 0});  // -z, turned to y, turned
  check_near(scene.view->up, {0, 0, 1});
  CHECK(half_height(*scene.view) == Approx(std::tan(20 * std::numbers::pi / 180)));
  CHECK((scene.view->width == 768 && scene.view->height == 512 && scene.view->hither == 0.25));
  REQUIRE(scene.lights.size() == 2);
  const auto& [lamp, sun] = std::tie(scene.lights[0], scene.lights[1]);
  CHECK((!lamp.is_sun && sun.is_sun && !sun.color));
  check_near(lamp.position, {8, 1, 3});
  REQUIRE(lamp.color);
  check_near(*lamp.color, {1, 0.5, 0.25});
  check_near(sun.position.normalized(), {1, 0, 0});  // it shines along -z, turned to y, turned to -x
}

TEST_CASE("format numbers: COLLADA's upward axis is turned to y") {
  const SceneDescription scene = read({{"a.dae", collada("<up_axis>Z_UP</up_axis>")}});
  REQUIRE(scene.polygons.size() == 1);
  check_near(scene.vertices(scene.polygons[0])[0], {8, 7, -2});
  check_near(scene.view.value().from, {5, 0, 0});
  check_near(scene.view->up, {0, 1, 0});
  check_near(scene.lights.at(0).position, {8, 3, -1});
}

TEST_CASE("format numbers: OBJ's materials and normals") {
  const SceneDescription scene =
      read({{"a.mtl",
             "newmtl glass\nKd .5 .25 .125\nKs .25 .5 .75\nNs 20\nd .25\nNi 1.33\nKe .1 .2 .3\nnewmtl "
             "dull\nKd 1 1 1\n"},
            {"a.obj",
             "mtllib a.mtl\nv 1 2 3\nv 4 2 3\nv 1 6 3\nv 1 2 9\nvn 0 0 1\nvn 1 0 0\nvn 0 1 0\nusemtl glass\n"
             "f 1//1 2//2 3//3\nusemtl dull\nf 1 2 4\n"}});
  REQUIRE((scene.patches.size() == 1 && scene.polygons.size() == 1));
  const std::span<const PatchVertex> corners = scene.vertices(scene.patches[0]);
  REQUIRE(corners.size() == 3);
  check_near(corners[1].position, {4, 2, 3});
  check_near(corners[2].position, {1, 6, 3});
  check_near(corners[0].normal, {0, 0, 1});
  check_near(corners[1].normal, {1, 0, 0});
  check_near(corners[2].normal, {0, 1, 0});
  const Material& glass = scene.materials[scene.patches[0].material];
  check_near(glass.color, {0.5, 0.25, 0.125});
  check_near(glass.emission, Rgb(0.1, 0.2, 0.3));
  CHECK((glass.specular == 0.5 && glass.shine == 20 && glass.transmittance == 0.75));
  CHECK(glass.refractive_index == Approx(1.33));
  check_near(scene.vertices(scene.polygons[0])[2], {1, 2, 9});
  CHECK(scene.materials[scene.polygons[0].material].color == Rgb(1, 1, 1));
}

TEST_CASE("format numbers: PLY's places and normals") {
  const SceneDescription scene =
      read({{"a.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
             "property list uchar int vertex_indices\nend_header\n"
             "1 2 3 0 0 1\n4 2 3 1 0 0\n1 6 3 0 1 0\n3 0 1 2\n"}});
  REQUIRE(scene.patches.size() == 1);
  const std::span<const PatchVertex> corners = scene.vertices(scene.patches[0]);
  check_near(corners[0].position, {1, 2, 3});
  check_near(corners[1].position, {4, 2, 3});
  check_near(corners[2].position, {1, 6, 3});
  check_near(corners[0].normal, {0, 0, 1});
  check_near(corners[1].normal, {1, 0, 0});
  check_near(corners[2].normal, {0, 1, 0});
  CHECK((!scene.view && scene.lights.empty()));
}

namespace {

const std::vector<double> kTurnedAndMoved = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1};  // by columns
const double kHalf = std::sqrt(0.5);

// A node in one that is turned by 90 degrees about z and moved by 10.
void put_inside(GltfSample& sample, int inner) {
  sample.document["scenes"][0]["nodes"] = {
      sample.add("nodes", {{"matrix", kTurnedAndMoved}, {"children", {inner}}})};
}

}  // namespace

TEST_CASE("format numbers: glTF's nodes in each other, its camera and lights") {
  GltfSample sample;
  const int mesh =
      sample.triangle({{"attributes", {{"POSITION", sample.numbers({1, 2, 4, 3, 2, 4, 1, 5, 4}, "VEC3")}}}});
  sample.add("cameras",
             {{"type", "perspective"},
              {"perspective", {{"yfov", 2 * std::atan(0.5)}, {"aspectRatio", 1.5}, {"znear", 0.25}}}});
  sample.document["extensionsUsed"] = {"KHR_lights_punctual"};
  sample.document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 1e6}}, {{"type", "directional"}}};
  const auto lit = [](int light) { return Json{{"KHR_lights_punctual", {{"light", light}}}}; };
  const int sun = sample.add("nodes", {{"extensions", lit(1)}});
  put_inside(sample, sample.add("nodes", {{"mesh", mesh},
                                          {"camera", 0},
                                          {"extensions", lit(0)},
                                          {"children", {sun}},
                                          {"translation", {0, 0, 3}},
                                          {"rotation", {kHalf, 0, 0, kHalf}},
                                          {"scale", {2, 1, 1}}}));
  const SceneDescription scene = sample.read().scene;
  REQUIRE(scene.polygons.size() == 1);
  const std::span<const Vec3d> corners = scene.vertices(scene.polygons[0]);
  check_near(corners[0],
             {14, 2, 5});  // (1 2 4), scaled (2 2 4), turned (2 -4 2), moved (2 -4 5), turned (4 2 5)
  check_near(corners[1], {14, 6, 5});
  check_near(corners[2], {14, 2, 8});
  REQUIRE(scene.view);
  check_near(scene.view->from, {10, 0, 3});
  check_near(scene.view->at, {9, 0, 3});
  check_near(scene.view->up, {0, 0, 1});
  CHECK(half_height(*scene.view) == Approx(0.5));
  CHECK((scene.view->width == 768 && scene.view->height == 512 && scene.view->hither == 0.25));
  REQUIRE(scene.lights.size() == 2);
  check_near(scene.lights[0].position, {10, 0, 3});
  REQUIRE(scene.lights[0].color);
  CHECK(scene.lights[0].color->x == 1);
  CHECK(scene.lights[0].color->y == Approx(0.735357).epsilon(1e-5));  // IEC 61966-2-1 of a half
  CHECK(scene.lights[0].color->z == Approx(0.537099).epsilon(1e-5));  // and of a quarter
  CHECK(scene.lights[1].is_sun);
  check_near(scene.lights[1].position.normalized(), {1, 0, 0});
}

TEST_CASE("format numbers: glTF's movement is that of a node in the space of the one around it") {
  GltfSample sample;
  const int inner = sample.add(
      "nodes",
      {{"name", "inner"}, {"mesh", sample.triangle()}, {"translation", {7, 7, 7}}, {"scale", {2, 3, 1}}});
  put_inside(sample, inner);
  sample.move(inner, "translation", "LINEAR", {1, 3}, {0, 0, 0, 4, 0, 8});
  const SceneDescription scene = sample.read().scene;
  REQUIRE(scene.movement.times);
  CHECK((scene.movement.times->start == 1 && scene.movement.times->end == 3));
  const auto corners_at = [&](double time) {
    const SceneDescription still = still_at(scene, time);
    const std::span<const Vec3d> corners = still.vertices(still.polygons.at(0));
    return std::vector<Vec3d>(corners.begin(), corners.end());
  };
  check_near(corners_at(1)[0], {10, 0, 0});
  check_near(corners_at(2)[0], {10, 2, 4});
  check_near(corners_at(2)[1], {10, 4, 4});  // (1 0 0), scaled (2 0 0), moved (4 0 4), turned (0 4 4)
  check_near(corners_at(2)[2], {7, 2, 4});
  check_near(corners_at(3)[0], {10, 4, 8});
}

}  // namespace pprt::format_numbers_test
