#include "scene/bytes/scene_bytes.h"

#include <catch2/catch.hpp>

#include "parser/aff_parser.h"

namespace pprt::scene_bytes_test {
namespace {

// Something of every kind.
constexpr const char* kEverything = R"(
v from 1 2 3 at 4 5 6 up 0 1 0 angle 40 hither 1 resolution 8 6
b .1 .2 .3 am 2 2 2 l 1 2 3 .1 .2 .3 la lamp 4 5 6 a 0 1 5 ls 0 1 .5 .9 .8 .7
bs 0 1 0 .9 .8 .7 .1 .2 .5
fm .1 .2 .3 .4 .5 .6 .7 .8 .9 10 .11 1.2
fet wood .5 .6 .7 s 1 2 3 4 c 0 0 0 1 0 0 5 .5
x body { xs 1 2 3 0 0 1 30 4 5 6 {
m vertices 3 0 0 0 1 0 0 0 1 0 normals 1 0 0 1 texturecoords 3 wood 0 0 1 0 0 1 triangles 1 0 1 2 0 0 0 0 1 2
} tpa 2 0 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 1 0 0 4 0 0 1 1 0 4 0 0 1 0 1 4 0 1 0 }
k body { transl 4 0 0 0 0 0 0 0 1 1 2 3 .1 .2 .3 2 0 0 0 0 0 0 3 0 0 0 0 0 0
rot 4 0 0 0 1 0 0 0 0 1 0 0 1 90 0 0 0 2 0 0 1 0 0 0 0 3 0 0 1 0 0 0 0 visibility 1 .5 0 })";

SceneDescription everything() {
  SceneDescription scene = parse_aff(kEverything, "e.aff").scene;
  scene.textures.at(0) = {"wood", 1, 2, {1, 2, 3, 4, 5, 6}};
  add_polygon(scene, std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0);
  scene.nodes.push_back(0);
  return scene;
}

}  // namespace

TEST_CASE("scene bytes: a scene arrives as it was sent, whatever it holds") {
  const SceneDescription scene = everything();
  const Bytes bytes = encode(scene);
  const SceneDescription back = decode_scene(bytes);
  CHECK(encode(back) == bytes);
  CHECK((back.name == "e.aff" && back.view->width == 8 && back.ambient == Rgb(2, 2, 2)));
  CHECK((back.materials == scene.materials && back.order == scene.order && back.nodes == scene.nodes));
  CHECK(back.textures == scene.textures);
  CHECK(back.meshes.at(0).texture_points == scene.meshes.at(0).texture_points);
  CHECK(back.moving_triangles.at(0).keys.at(1).positions ==
        scene.moving_triangles.at(0).keys.at(1).positions);
  CHECK(back.light_nodes.at(1).track == "lamp");
  CHECK((!back.lights.at(1).is_sun && back.lights.at(2).is_sun));
  CHECK(back.sky == scene.sky);
  CHECK(back.sky->zenith == Rgb(.1, .2, .5));
  CHECK(back.movement.times->frames == 5);
  const auto here = placements_at(scene.movement, 1.3), there = placements_at(back.movement, 1.3);
  REQUIRE(there.size() == here.size());
  for (std::size_t i = 0; i < here.size(); ++i) CHECK(there[i].to_parent == here[i].to_parent);
}

TEST_CASE("scene bytes: a scene cut short anywhere is refused") {
  const Bytes whole = encode(everything());
  for (std::size_t size = 0; size < whole.size(); ++size)
    CHECK_THROWS_AS(decode_scene({whole.data(), size}), ProtocolError);
}

TEST_CASE("scene bytes: the hash is that of the content, not of names and places") {
  const SceneDescription scene = everything();
  SceneDescription renamed = scene;
  renamed.name = "f.aff", renamed.spheres[0].location = {77, 7}, renamed.textures[0].name = "oak";
  CHECK(hash_of(renamed) == hash_of(scene));
  SceneDescription other = scene;
  other.textures[0].rgb[5] = 7;
  CHECK(hash_of(other) != hash_of(scene));
}

}  // namespace pprt::scene_bytes_test
