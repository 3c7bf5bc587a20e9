// Nodes that rest are transformed away.
#include "scene/animation/resting_nodes.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pprt::resting_nodes_test {

namespace {

constexpr NodeIndex kWorld = 0;

// Adds a node and returns its number.
NodeIndex add_node(SceneDescription& scene, NodeIndex parent, const Affine& map,
                   const std::string& track = "") {
  scene.movement.nodes.push_back({.parent = parent, .to_parent = map, .track = track, .location = {}});
  return static_cast<NodeIndex>(scene.movement.nodes.size() - 1);
}

void put(SceneDescription& scene, const Sphere& sphere, NodeIndex node) {
  add_sphere(scene, sphere);
  scene.nodes.push_back(node);
}

bool close(const Vec3d& a, const Vec3d& b) {
  return (a - b).length() < 1e-12;
}

}  // namespace

TEST_CASE("resting nodes: what rests in the world comes into it, at any depth") {
  SceneDescription scene;
  scene.materials.resize(1);
  const NodeIndex outer = add_node(scene, kWorld, translation({1, 0, 0}));
  const NodeIndex inner = add_node(scene, outer, rotation({0, 0, 1}, 90) * scaling({2, 2, 2}));
  put(scene, {{1, 0, 0}, 1, 0, {}}, inner);
  put(scene, {{5, 0, 0}, 3, 0, {}}, kWorld);
  scene.lights.push_back({{1, 0, 0}, {}, {}});
  scene.light_nodes.push_back({.node = inner});
  const SceneDescription still = without_resting_nodes(scene);
  CHECK((still.movement.nodes.size() == 1 && still.nodes.empty() && still.light_nodes.empty()));
  CHECK(close(still.spheres[0].center, {1, 2, 0}));
  CHECK(still.spheres[0].radius == Approx(2));
  CHECK(still.spheres[1].center == Vec3d(5, 0, 0));
  CHECK(close(still.lights[0].position, {1, 2, 0}));
}

TEST_CASE("resting nodes: one within what moves, and one about it") {
  SceneDescription scene;
  scene.materials.resize(1);
  const NodeIndex about = add_node(scene, kWorld, translation({0, 5, 0}));
  const NodeIndex moves = add_node(scene, about, {}, "car");
  const NodeIndex within = add_node(scene, moves, translation({0, 0, 1}));
  put(scene, {{1, 0, 0}, 1, 0, {}}, within);
  MotionTrack& track = scene.movement.tracks["car"];
  for (const double time : {0.0, 1.0, 2.0, 3.0}) track.translation.push_back({time, {time, 0, 0}, {}});
  const SceneDescription settled = without_resting_nodes(scene);
  CHECK(close(settled.spheres[0].center, {1, 0, 1}));
  const auto before = placements_at(scene.movement, 1.5), after = placements_at(settled.movement, 1.5);
  CHECK(close(after[settled.nodes[0]].to_parent.point(settled.spheres[0].center),
              before[within].to_parent.point({1, 0, 0})));
  const SceneDescription still = still_at(scene, 1.5);
  CHECK(close(still.spheres[0].center, {2.5, 5, 1}));
  CHECK(still.movement.nodes.size() == 1);
}

TEST_CASE("resting nodes: a sphere or cone that is stretched keeps its node, a mesh does not") {
  SceneDescription scene;
  scene.materials.resize(1);
  const NodeIndex stretched = add_node(scene, kWorld, scaling({1, 2, 1}));
  put(scene, {{0, 1, 0}, 1, 0, {}}, stretched);
  add_cone(scene, {{0, 0, 0}, 1, {0, 1, 0}, 1, 0, {}});
  scene.nodes.push_back(stretched);
  const TriangleMesh mesh{
      .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {{1, 1, 0}}, .texture_points = {}};
  const TriangleCorners corners{.position = {0, 1, 2}, .normal = {}, .texture_point = {}};
  add_mesh(scene, mesh, {&corners, 1});
  scene.nodes.push_back(stretched);
  const SceneDescription settled = without_resting_nodes(scene);
  CHECK(settled.movement.nodes.size() == 2);
  CHECK(settled.nodes == std::vector<NodeIndex>{1, 1, 0});
  CHECK(settled.spheres[0].center == Vec3d(0, 1, 0));
  CHECK(settled.meshes[0].positions[2] == Vec3d(0, 2, 0));
  CHECK(close(settled.meshes[0].normals[0].normalized(), Vec3d(2, 1, 0).normalized()));
}

TEST_CASE("resting nodes: a mirror keeps fronts in front") {
  SceneDescription scene;
  scene.materials.resize(1);
  const NodeIndex mirror = add_node(scene, kWorld, scaling({-1, 1, 1}));
  const TriangleMesh mesh{
      .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {{0, 0, 1}}, .texture_points = {}};
  const TriangleCorners corners{.position = {0, 1, 2}, .normal = {}, .texture_point = {}};
  add_mesh(scene, mesh, {&corners, 1});
  add_polygon(scene, mesh.positions, 0);
  scene.nodes = {mirror, mirror};
  const SceneDescription settled = without_resting_nodes(scene);
  const auto front = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) { return (b - a).cross(c - a).z; };
  const auto& p = settled.meshes[0].positions;
  const auto& t = settled.triangles[0].corners.position;
  CHECK(front(p[t[0]], p[t[1]], p[t[2]]) > 0);
  CHECK(settled.meshes[0].normals[0].z > 0);
  const auto v = settled.vertices(settled.polygons[0]);
  CHECK(front(v[0], v[1], v[2]) > 0);
}

TEST_CASE("resting nodes: normals stay numbers of a scene where a node scales beyond all measure") {
  const double scale = GENERATE(1e-63, 1.0, 1e63);
  SceneDescription scene;
  scene.materials.resize(1);
  const NodeIndex node = add_node(scene, kWorld, scaling({scale, scale, scale}));
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0.6, 0.8}, {0, 0, 0}};
  const TriangleCorners corners{.position = {0, 1, 2}, .normal = {0, 1, 2}, .texture_point = {}};
  add_mesh(scene, mesh, {&corners, 1});
  scene.nodes.push_back(node);
  const TriangleMesh still = without_resting_nodes(scene).meshes[0];
  CHECK(still.positions[1].x == scale);
  CHECK(close(still.normals[0], {0, 0, 1}));
  CHECK(close(still.normals[1], {0, 0.6, 0.8}));
  CHECK(still.normals[2] == Vec3d(0, 0, 0));
}

}  // namespace pprt::resting_nodes_test
