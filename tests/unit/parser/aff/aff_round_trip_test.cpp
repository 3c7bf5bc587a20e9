// What is written as AFF reads back as the same scene.
#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

#include "parser/aff_parser.h"
#include "scene/animation/resting_nodes.h"
#include "scene/description/shading_rules.h"
#include "scene/writers/aff_writer.h"

namespace pprt::aff_round_trip_test {

namespace {

std::string written(const SceneDescription& scene, const std::vector<std::string>& textures = {}) {
  std::ostringstream out;
  write_aff(scene, out, textures);
  return out.str();
}

SceneDescription parsed(const std::string& text) {
  const ParsedScene parsed = parse_aff(text, "a.aff", {.strict = true});
  CHECK(parsed.warnings.empty());
  return parsed.scene;
}

// Where a point of every node stands in the world at a time.
std::vector<Vec3d> marks(const SceneDescription& scene, double time) {
  std::vector<Vec3d> result;
  const std::vector<Placement> placements = placements_at(scene.movement, time);
  for (std::size_t place = 0; place < scene.order.size(); ++place) {
    const Placement& p = placements[node_of(scene, place)];
    result.push_back(p.to_parent.point(bounds(scene, scene.order[place]).center()));
    result.emplace_back(p.visible, scene.order[place].index, 0);
  }
  return result;
}

constexpr const char* kScene = R"(
b .1 .2 .3
bs .1 1 0  .9 .8 .7  .1 .2 .5
ls 0 .1 -2 .6 .5 .4
v from 0 1 9 at 0 0.1 0 up 0 1 0 angle 33.3 hither 1 resolution 64 48
am .5 .6 .7
a -1 5 7
l 1 2 3 .3 .4 .5
la lamp 4 5 6 1 1 1
k lamp { transl 4 -2 0 0 0 0 0 0 -1 0 0 0 .1 .2 .3 2 1 1 1 0 0 0 3 0 0 0 0 0 0 }
k camera { rot 4 -2 0 1 0 5 0 0 0 -1 0 1 0 10 0 0 0 4 0 1 0 20 0 .5 0 5 1 0 0 30 0 0 0 }
k top { transl 4 -2 0 0 0 0 0 0 -1 1 0 0 .1 .2 .3 2 1 3 1 0 0 0 3 0 0 0 0 0 0
        visibility 2 0 0 3.5 1 }
k inner { scale 4 -2 1 1 1 0 0 0 -1 1 1 1 0 0 0 2 1 3 2 0 0 0 3 1 1 1 0 0 0 }
f 1 .5 .25 .5 .25 10 0 1 s 9 9 9 .5
x top {
  fm .1 .2 .3 .4 .5 .6 .7 .8 .9 20 .5 1.3
  c 0 0 0 1  0 2 0 .5
  xs 2 1 1  0 0 1 30  5 0 0 { s 0 0 0 1
    x inner { p 3  0 0 0  1 0 0  0 1 0   pp 3  0 0 0 0 0 1  1 0 0 0 1 1  0 1 0 1 0 1 } }
  tpa 2  0  0 0 0 0 0 1  1 0 0 0 0 1  0 1 0 0 0 1   2  0 0 1 0 0 1  1 0 1 0 0 1  0 1 1 0 0 1
}
x inner { m vertices 4  0 0 0  1 0 0  1 1 0  0 1 0  normals 1  0 0 1
  texturecoords 4 wood.ppm  0 0  1 0  1 1  0 1
  triangles 2  0 1 2  0 0 0  0 1 2   0 2 3  0 0 0  0 2 3 }
fe .4 .5 4
m vertices 3  0 0 0  1 0 0  1 1 0  triangles 1  2 1 0
fet glow.ppm .3 .2 .1
tt - 0 0 0 0 0  1 0 0 1 0  0 1 0 0 1
)";

}  // namespace

TEST_CASE("a scene with every directive reads back as it was written") {
  const SceneDescription scene = without_resting_nodes(parsed(kScene));
  const SceneDescription back = without_resting_nodes(parsed(written(scene, {"other.png", "light.png"})));

  CHECK(back.background == scene.background);
  CHECK(back.ambient == scene.ambient);
  CHECK(back.sky == scene.sky);
  CHECK(scene.sky->horizon == Rgb(.9, .8, .7));
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    CHECK(back.lights[i].is_sun == scene.lights[i].is_sun);
    CHECK(back.lights[i].position == scene.lights[i].position);
  }
  CHECK(std::count_if(scene.lights.begin(), scene.lights.end(), [](const Light& l) { return l.is_sun; }) ==
        1);
  CHECK(back.materials.size() == scene.materials.size());
  for (std::size_t i = 0; i < scene.materials.size(); ++i) CHECK(back.materials[i] == scene.materials[i]);
  CHECK(back.materials.back().emission == Rgb(.3, .2, .1));
  CHECK((!back.materials.back().texture && back.materials.back().emission_texture));
  REQUIRE(back.textures.size() == 2);
  CHECK(back.textures[0].name == "other.png");
  CHECK(back.meshes[0].texture_points == scene.meshes[0].texture_points);
  CHECK((back.movement.times->start == -1 && back.movement.times->end == 5 &&
         back.movement.times->frames == 7));
  CHECK(back.order == scene.order);
  REQUIRE(back.movement.tracks.size() == 4);
  CHECK(back.light_nodes[2].track == "lamp");
  for (const double time : {-1.0, 0.0, 0.7, 1.9, 3.0, 4.0}) {
    CAPTURE(time);
    const std::vector<Vec3d> a = marks(scene, time), b = marks(back, time);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) CHECK((a[i] - b[i]).length() < 1e-12);
    CHECK(view_at(scene, time)->at == view_at(back, time)->at);
  }
  CHECK((marks(scene, 0.7)[2] - marks(back, 1.9)[2]).length() > 0.1);  // the control: another time
}

TEST_CASE("any map of a resting node is written as one or two transforms") {
  const Affine shear{{1, 0, 0}, {0.5, 1, 0}, {0, 0.25, 2}, {7, 8, 9}};
  const Affine mirror = rotation({1, 2, 3}, 77) * scaling({2, 3, -4});
  const Affine half_turn = rotation({0, 1, 0}, 180) * scaling({1, 2, 3});
  const Affine flat = scaling({1, 2, 0});
  const Affine nothing = scaling({0, 0, 0});
  for (const Affine& map : {shear, mirror, half_turn, flat, nothing, shear * mirror}) {
    SceneDescription scene;
    scene.materials.emplace_back();
    add_sphere(scene, {.center = {1, 2, 3}, .radius = 1, .material = 0, .location = {}});
    scene.movement.nodes.push_back({.parent = 0, .to_parent = map});
    scene.nodes = {1};
    const SceneDescription back = parsed(written(scene));
    const Affine found = placements_at(back.movement, 0)[back.nodes[0]].to_parent;
    for (const auto& [a, b] : {std::pair(found.x, map.x), std::pair(found.y, map.y),
                               std::pair(found.z, map.z), std::pair(found.origin, map.origin)})
      CHECK((a - b).length() < 1e-13 * (1 + b.length()));
  }
}

TEST_CASE("a scene in NFF keeps its brightness in AFF") {
  SceneDescription scene;
  Material m;
  m.color = {0.5, 0.25, 1}, m.diffuse = 0.5, m.specular = 0.25, m.shine = 12;
  scene.materials.push_back(m);
  add_sphere(scene, {.center = {0, 0, 0}, .radius = 1, .material = 0, .location = {}});
  scene.lights = {{{1, 2, 3}, {}, {}}, {{4, 5, 6}, Rgb(1, 0.5, 0), {}}};
  const SceneDescription back = parsed(written(scene));
  const double weight = light_weight(2);
  CHECK(*back.lights[0].color == Rgb(1, 1, 1) * weight);
  CHECK(*back.lights[1].color == Rgb(1, 0.5, 0) * weight);
  const TermColors& terms = back.materials[0].terms.value();
  CHECK(terms.diffuse == Rgb(0.25, 0.125, 0.5));
  const Rgb ambient = terms.ambient * *back.ambient;
  CHECK(ambient.x == Approx(0.5 * kAmbientReflectance * weight));
}

TEST_CASE("names that AFF cannot hold are changed, and stay apart") {
  SceneDescription scene;
  scene.materials.emplace_back();
  MotionTrack track;
  track.visibility = {{0, false}};
  for (const char* name : {"a b", "a_b", "a{b"}) {
    scene.movement.tracks[name] = track;
    scene.movement.nodes.push_back({.parent = 0, .track = name});
    add_sphere(scene, {.center = {0, 0, 0}, .radius = 1, .material = 0, .location = {}});
    scene.nodes.push_back(static_cast<NodeIndex>(scene.movement.nodes.size() - 1));
  }
  const SceneDescription back = parsed(written(scene));
  CHECK(back.movement.tracks.size() == 3);
  CHECK(placements_at(back.movement, 1)[back.nodes[2]].visible == false);
}

}  // namespace pprt::aff_round_trip_test
