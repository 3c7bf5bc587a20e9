// Objects that scripts move.
#include "scene/animation/object_motion.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::object_motion_test {

namespace {

ObjectMotion with_keys(std::vector<ObjectKey> keys) {
  return {.name = "it", .location = {}, .keys = std::move(keys)};
}

Vec3d place_of(const MotionTrack& track, const Vec3d& point, double time) {
  return placement_at(track, time).to_parent.point(point);
}

bool close(const Vec3d& a, const Vec3d& b) {
  return (a - b).length() < 1e-9;
}

}  // namespace

TEST_CASE("object motion: two keys make an even movement, which stands still outside them") {
  const FrameTimes times{.start = 0, .end = 2, .frames = 5};
  ObjectKey first, last;
  first.frame = 2, last.frame = 4, last.translate = {4, 0, -2}, last.scale = {3, 1, 1};
  const MotionTrack track = track_of(with_keys({first, last}), times);
  CHECK(close(place_of(track, {1, 0, 0}, 0), {1, 0, 0}));
  CHECK(close(place_of(track, {1, 0, 0}, 0.5), {1, 0, 0}));
  CHECK(close(place_of(track, {1, 0, 0}, 1), {2 + 2, 0, -1}));
  CHECK(close(place_of(track, {1, 0, 0}, 0.75), {1 + 1.5, 0, -0.5}));
  CHECK(close(place_of(track, {1, 0, 0}, 1.5), {4 + 3, 0, -2}));
  CHECK(close(place_of(track, {1, 0, 0}, 9), {4 + 3, 0, -2}));
}

TEST_CASE("object motion: turns go about x, then y, then z, and may be of many times 360 degrees") {
  const FrameTimes times{.start = 1, .end = 3, .frames = 9};
  ObjectKey first, last;
  last.frame = 9;
  SECTION("the order") {
    first.rotate = last.rotate = {90, 90, 0};
    const MotionTrack track = track_of(with_keys({first, last}), times);
    // y goes to z about x, then z to x about y.
    CHECK(close(place_of(track, {0, 1, 0}, 2), {1, 0, 0}));
    CHECK(close(place_of(track, {0, 0, 1}, 2), {0, -1, 0}));
  }
  SECTION("two turns in eight frames: a quarter in each") {
    last.rotate = {0, 0, 720};
    const MotionTrack track = track_of(with_keys({first, last}), times);
    for (int frame = 0; frame < 9; ++frame) {
      const double angle = frame * std::acos(-1.0) / 2;
      CHECK(close(place_of(track, {1, 0, 0}, time_of_frame(times, frame)),
                  {std::cos(angle), std::sin(angle), 0}));
    }
  }
  SECTION("half a turn, whose axis the difference of elements does not tell") {
    for (const Vec3d& turn : {Vec3d(180, 0, 0), Vec3d(0, 180, 0), Vec3d(0, 0, 180), Vec3d(180, 90, 0)}) {
      first.rotate = last.rotate = turn;
      const MotionTrack track = track_of(with_keys({first, last}), times);
      const Affine exact =
          rotation({0, 0, 1}, turn.z) * rotation({0, 1, 0}, turn.y) * rotation({1, 0, 0}, turn.x);
      for (const Vec3d& p : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)})
        CHECK((place_of(track, p, 2) - exact.point(p)).length() < 1e-6);
    }
  }
}

TEST_CASE("object motion: one key, one frame, no key") {
  ObjectKey only;
  only.translate = {1, 2, 3}, only.rotate = {0, 0, 90}, only.scale = {2, 2, 2};
  for (const int frames : {1, 2, 3}) {
    const MotionTrack track = track_of(with_keys({only}), {.start = 0, .end = 1, .frames = frames});
    CHECK(close(place_of(track, {1, 0, 0}, 0), {1, 4, 3}));
    CHECK(close(place_of(track, {1, 0, 0}, 1), {1, 4, 3}));
  }
  CHECK(track_of(with_keys({}), {}).translation.empty());
}

TEST_CASE("object motion: a part of a scene is seen from its key on") {
  ObjectKey first, last;
  first.visible = false, last.frame = 3;
  const MotionTrack track = track_of(with_keys({first, last}), {.start = 0, .end = 1, .frames = 5});
  CHECK_FALSE(placement_at(track, 0.25).visible);
  CHECK(placement_at(track, 0.5).visible);
}

TEST_CASE("object motion: the objects of another scene keep their materials, textures and nodes") {
  SceneDescription scene, other;
  scene.materials.resize(2);
  add_sphere(scene, {{0, 0, 0}, 1, 1, {}});
  scene.textures.push_back({"a", 1, 1, {1, 2, 3}});
  other.materials.resize(1);
  other.materials[0].texture = 0;
  other.textures.push_back({"b", 1, 1, {4, 5, 6}});
  other.movement.nodes.push_back({.parent = 0, .to_parent = {}, .track = "wheel", .location = {}});
  other.movement.tracks["wheel"] = {};
  add_sphere(other, {{0, 0, 0}, 2, 0, {7, 7}});
  const TriangleMesh mesh{
      .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {}, .texture_points = {}};
  const TriangleCorners corners{.position = {0, 1, 2}, .normal = {}, .texture_point = {}};
  add_mesh(other, mesh, {&corners, 1});
  other.nodes = {0, 1};
  other.lights.emplace_back();

  add_moving(scene, other, "car");
  add_moving(scene, other, "bus");
  CHECK(scene.order.size() == 5);
  CHECK(scene.lights.empty());
  CHECK(scene.nodes == std::vector<NodeIndex>{0, 1, 2, 3, 4});
  CHECK(scene.movement.nodes[1].track == "car");
  CHECK((scene.movement.nodes[2].track == "car/wheel" && scene.movement.nodes[2].parent == 1));
  CHECK((scene.movement.nodes[4].track == "bus/wheel" && scene.movement.nodes[4].parent == 3));
  CHECK(scene.movement.tracks.contains("bus/wheel"));
  CHECK(scene.materials.size() == 4);
  CHECK((scene.materials[2].texture == TextureIndex{1} && scene.materials[3].texture == TextureIndex{2}));
  CHECK(material_of(scene, scene.order[1]) == 2);
  CHECK((material_of(scene, scene.order[4]) == 3 && scene.triangles[1].mesh == 1));
  CHECK(location_of(scene, scene.order[1]).line == 0);
}

}  // namespace pprt::object_motion_test
