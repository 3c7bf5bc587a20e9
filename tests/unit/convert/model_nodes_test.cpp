// Nodes in each other, and movement by Assimp's keys: where things stand, by hand.
#include <assimp/anim.h>
#include <assimp/scene.h>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "convert/mesh/mesh_animation.h"
#include "convert/model/model_builder.h"
#include "scene/animation/resting_nodes.h"

namespace pprt::model_nodes_test {
namespace {

Affine scale(double factor) {
  return {{factor, 0, 0}, {0, factor, 0}, {0, 0, factor}, {0, 0, 0}};
}

MotionTrack track_to(double time, const Vec3d& place) {
  MotionTrack track;
  track.translation = {{0, {0, 0, 0}}, {time, place}};
  make_straight(track.translation);
  note_order(track);
  return track;
}

// Assimp's scenes own what they are given.
std::unique_ptr<aiNodeAnim> channel(const char* node) {
  auto channel = std::make_unique<aiNodeAnim>();
  channel->mNodeName = node;
  return channel;
}

void turn(aiNodeAnim& channel, const std::vector<std::pair<double, double>>& ticks_and_degrees) {
  channel.mNumRotationKeys = static_cast<unsigned>(ticks_and_degrees.size());
  channel.mRotationKeys = new aiQuatKey[ticks_and_degrees.size()];
  for (std::size_t i = 0; i < ticks_and_degrees.size(); ++i) {
    const auto [ticks, degrees] = ticks_and_degrees[i];
    const double half = degrees * (3.14159265358979 / 360);
    channel.mRotationKeys[i] = {
        ticks, aiQuaternion(static_cast<float>(std::cos(half)), 0, 0, static_cast<float>(std::sin(half)))};
  }
}

void move(aiNodeAnim& channel, const std::vector<std::pair<double, float>>& ticks_and_x) {
  channel.mNumPositionKeys = static_cast<unsigned>(ticks_and_x.size());
  channel.mPositionKeys = new aiVectorKey[ticks_and_x.size()];
  for (std::size_t i = 0; i < ticks_and_x.size(); ++i)
    channel.mPositionKeys[i] = {ticks_and_x[i].first, aiVector3D(ticks_and_x[i].second, 0, 0)};
}

void add_animation(aiScene& scene, const char* name, double ticks_per_second,
                   std::vector<std::unique_ptr<aiNodeAnim>> channels) {
  auto animation = std::make_unique<aiAnimation>();
  animation->mName = name;
  animation->mTicksPerSecond = ticks_per_second;
  animation->mNumChannels = static_cast<unsigned>(channels.size());
  animation->mChannels = new aiNodeAnim*[channels.size()];
  for (std::size_t i = 0; i < channels.size(); ++i) animation->mChannels[i] = channels[i].release();
  auto** all = new aiAnimation*[scene.mNumAnimations + 1];
  std::copy_n(scene.mAnimations, scene.mNumAnimations, all);
  all[scene.mNumAnimations++] = animation.release();
  delete[] scene.mAnimations;
  scene.mAnimations = all;
}

template <class... Channels>
std::vector<std::unique_ptr<aiNodeAnim>> all_of(Channels... channels) {
  std::vector<std::unique_ptr<aiNodeAnim>> all;
  (all.push_back(std::move(channels)), ...);
  return all;
}

}  // namespace

TEST_CASE("model builder: a node's transform is applied before that of the node around it") {
  ModelBuilder builder("model");
  const ModelSpace outer = builder.space_of({}, translation({10, 0, 0}), "outer");
  const ModelSpace inner = builder.space_of(outer, scale(2), "inner");
  CHECK((outer.node == 0 && inner.node == 0));
  CHECK(inner.map.point({1, 2, 3}) == Vec3d(12, 4, 6));
  const ModelSpace other = builder.space_of(builder.space_of({}, scale(2), ""), translation({10, 0, 0}), "");
  CHECK(other.map.point({1, 2, 3}) == Vec3d(22, 4, 6));
}

TEST_CASE("model builder: what moves has a node of its own, in the space of the node around it") {
  ModelBuilder builder("model");
  builder.scene().movement.tracks["moves"] = track_to(2, {4, 0, 0});
  const ModelSpace outer = builder.space_of({}, translation({10, 0, 0}) * scale(2), "rests");
  const ModelSpace moving = builder.space_of(outer, translation({77, 0, 0}), "moves");  // the track's counts
  const ModelSpace inner = builder.space_of(moving, translation({0, 1, 0}), "inside");
  CHECK((moving.node != 0 && moving.map == Affine() && inner.node == moving.node));
  const auto place_at = [&](double time) {
    const std::vector<Placement> places = placements_at(builder.scene().movement, time);
    return places[inner.node].to_parent.point(inner.map.point({0, 0, 0}));
  };
  CHECK((place_at(0) - Vec3d(10, 2, 0)).length() < 1e-9);
  CHECK((place_at(1) - Vec3d(14, 2, 0)).length() < 1e-9);
  CHECK((place_at(2) - Vec3d(18, 2, 0)).length() < 1e-9);
}

TEST_CASE("model builder: a camera that its nodes flatten is left out, or looks as it did at the start") {
  const auto built = [](const Vec3d& first, const Vec3d& last) {
    ModelBuilder builder("model");
    MotionTrack track;
    track.scale = {{0, first}, {2, last}};
    make_straight(track.scale);
    note_order(track);
    builder.scene().movement.tracks["moves"] = track;
    builder.add(ModelCamera{.name = "eye", .half_height = 0.5, .from = {1, 2, 3}},
                builder.space_of({}, Affine(), "moves"));
    return std::move(builder).finish({});
  };
  const ReadMesh flat = built({1, 0, 1}, {1, 1, 1});  // up has no direction
  CHECK_FALSE(flat.scene.view);
  CHECK_FALSE(flat.scene.movement.tracks.contains(kCameraTrack));
  CHECK(flat.notes == std::vector<std::string>{"the camera 'eye' is flattened by its nodes: left out"});
  const ReadMesh passing = built({1, 1, 1}, {1, 1, -1});  // at 1 it has no direction
  CHECK(passing.notes.empty());
  REQUIRE(passing.scene.view);
  CHECK(passing.scene.view->from == Vec3d(1, 2, 3));
  const MotionTrack& track = passing.scene.movement.tracks.at(kCameraTrack);
  for (const RotationKey& key : track.rotation) {
    CAPTURE(key.time, key.degrees);
    CHECK((std::isfinite(key.degrees) && std::isfinite(key.axis.length())));
  }
  const auto turned_at = [&](double time) { return values_at(track, time).rotation.z.z; };
  CHECK(turned_at(0) == Approx(1));
  CHECK(turned_at(0.9) == Approx(1));
  CHECK(turned_at(2) == Approx(-1));
}

TEST_CASE("model animation: Assimp's keys are in ticks, and turns by half their quaternions' angle") {
  aiScene scene;
  auto wheel = channel("wheel");
  turn(*wheel, {{0, 0}, {30, 90}, {60, 170}});
  move(*wheel, {{0, 1.0F}, {60, 5.0F}});
  add_animation(scene, "roll", 30, all_of(std::move(wheel)));
  const ModelAnimation animation = read_animation(scene, "");
  REQUIRE(animation.tracks.contains("wheel"));
  const MotionTrack& track = animation.tracks.at("wheel");
  const auto degrees_at = [&](double time) {
    const Vec3d x = values_at(track, time).rotation.vector({1, 0, 0});
    return std::atan2(x.y, x.x) * (180 / 3.14159265358979);
  };
  CHECK(degrees_at(0) == Approx(0).margin(1e-3));
  CHECK(degrees_at(1) == Approx(90).margin(1e-3));
  CHECK(degrees_at(2) == Approx(170).margin(1e-3));
  CHECK(values_at(track, 1).translation.x == Approx(3));
  REQUIRE(animation.times);
  CHECK((animation.times->start == 0 && animation.times->end == 2 && animation.times->frames == 49));
}

TEST_CASE("model animation: without a name all of Assimp's count, the first of a node, else the one named") {
  aiScene scene;
  auto first = channel("a"), second = channel("a"), other = channel("b");
  move(*first, {{0, 0.0F}, {25, 1.0F}});
  move(*second, {{0, 0.0F}, {25, 9.0F}});
  move(*other, {{0, 0.0F}, {50, 2.0F}});
  add_animation(scene, "one", 0, all_of(std::move(first)));  // 25 ticks a second where none are told
  add_animation(scene, "two", 0, all_of(std::move(second), std::move(other)));
  const auto x_at_1 = [](const ModelAnimation& animation, const char* node) {
    return values_at(animation.tracks.at(node), 1).translation.x;
  };
  const ModelAnimation all = read_animation(scene, "");
  CHECK((x_at_1(all, "a") == Approx(1) && x_at_1(all, "b") == Approx(1)));
  CHECK(all.times->end == 2);
  CHECK(all.notes == std::vector<std::string>{"1 movement of a node that another animation moves: left out"});
  const ModelAnimation named = read_animation(scene, "two");
  CHECK((x_at_1(named, "a") == Approx(9) && named.notes.empty()));
  const ModelAnimation alone = read_animation(scene, "one");
  CHECK((alone.tracks.size() == 1 && alone.times->end == 1));
  CHECK_THROWS_WITH(read_animation(scene, "three"), "it has no animation 'three', but 'one', 'two'");
}

}  // namespace pprt::model_nodes_test
