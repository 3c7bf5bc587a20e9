#include "convert/model/model_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "base/printable.h"
#include "convert/model/camera_track.h"
#include "parser/text/text_input.h"
#include "scene/animation/animation.h"
#include "scene/animation/resting_nodes.h"
#include "scene/movement/movement_limits.h"
#include "scene/movement/straight_track.h"
#include "scene/polygons/triangulate.h"

namespace pprt {
namespace {

constexpr std::size_t kMaxPolygons = 20'000'000;

// The transforms of a node that moves: one that stretches askew is written as two.
static_assert(3 * kMaxNodeDepth <= kMostTransforms);

// Cosine from which on a vertex' normal is taken for the polygon's: half a degree.
constexpr double kSameDirection = 0.99996;

constexpr const char* kNodeCalledCamera = "camera_node";  // "camera" moves the view

bool is_usable(const View& view) {
  return view.angle_degrees > 0 && view.angle_degrees < 180 &&
         camera_defect(view.from, view.at, view.up).empty();
}

}  // namespace

bool is_in_range(double v) {
  return std::abs(v) <= kLargestNumber;
}

bool is_in_range(const Vec3d& v) {
  return is_in_range(v.x) && is_in_range(v.y) && is_in_range(v.z);
}

void ModelBuilder::reject(const std::string& problem) const {
  throw InputError(scene_.name + ": error: " + problem);
}

void ModelBuilder::note(std::size_t count, std::string_view one, std::string_view many) {
  if (count > 0) notes_.push_back(counted(count, one, many));
}

std::string ModelBuilder::track_name(const std::string& node) {
  return node == kCameraTrack ? kNodeCalledCamera : node;
}

ModelSpace ModelBuilder::space_of(const ModelSpace& parent, const Affine& own, const std::string& track) {
  const Affine map = parent.map * own;
  if (!is_in_range(map.x) || !is_in_range(map.y) || !is_in_range(map.z) || !is_in_range(map.origin))
    reject("a transform is not finite, or beyond 1e100");
  if (!scene_.movement.tracks.contains(track)) return {parent.node, map};
  const NodeIndex around = add_node({.parent = parent.node, .to_parent = parent.map});
  return {add_node({.parent = around, .track = track}), {}};
}

NodeIndex ModelBuilder::add_node(SceneNode node) {
  scene_.movement.nodes.push_back(std::move(node));
  return static_cast<NodeIndex>(scene_.movement.nodes.size() - 1);
}

void ModelBuilder::add(const ModelMesh& mesh, const Material& material, const ModelSpace& space) {
  for (const std::uint32_t corner : mesh.corners) {
    if (corner >= mesh.positions.size()) reject("a face names a vertex that is not there");
  }
  Material own = material;
  if (mesh.texture_points.empty()) own.texture.reset(), own.emission_texture.reset();
  const MaterialIndex index = table_.intern(scene_.materials, own);
  const bool mirrored = space.map.determinant() < 0;
  const std::vector<PatchVertex> vertices = vertices_of(mesh, space);
  own.has_picture() ? textured_mesh(mesh, vertices, mirrored, index)
                    : polygons(mesh, vertices, mirrored, index);
  scene_.nodes.resize(scene_.order.size(), space.node);
}

std::vector<PatchVertex> ModelBuilder::vertices_of(const ModelMesh& mesh, const ModelSpace& space) const {
  std::vector<PatchVertex> vertices(mesh.positions.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].position = space.map.point(mesh.positions[i]);
    if (!is_in_range(vertices[i].position)) reject("a coordinate is not finite, or beyond 1e100");
    if (mesh.normals.empty()) continue;
    const Vec3d normal = space.map.outward(mesh.normals[i]).normalized();
    if (is_in_range(normal)) vertices[i].normal = normal;
  }
  return vertices;
}

void ModelBuilder::polygons(const ModelMesh& mesh, const std::vector<PatchVertex>& vertices, bool mirrored,
                            MaterialIndex material) {
  std::size_t begin = 0;
  for (const std::size_t end : mesh.ends) {
    positions_.clear();
    vertices_.clear();
    for (std::size_t k = begin; k < end; ++k) {
      vertices_.push_back(vertices[mesh.corners[mirrored ? begin + end - 1 - k : k]]);
      positions_.push_back(vertices_.back().position);
    }
    polygon(material);
    begin = end;
  }
}

void ModelBuilder::polygon(MaterialIndex material) {
  const Vec3d plane = newell_normal(positions_).normalized();
  if (plane == Vec3d(0, 0, 0)) {
    ++skipped_;
    return;
  }
  count_polygons(1);
  const bool flat = std::all_of(vertices_.begin(), vertices_.end(), [&](const PatchVertex& v) {
    return v.normal == Vec3d(0, 0, 0) || v.normal.dot(plane) > kSameDirection;
  });
  if (flat) {
    add_polygon(scene_, positions_, material);
  } else {
    add_patch(scene_, vertices_, material);
  }
}

void ModelBuilder::count_polygons(std::size_t more) const {
  if (scene_.primitive_count() + more > kMaxPolygons) reject("it has more than 20 million polygons");
}

void ModelBuilder::textured_mesh(const ModelMesh& mesh, const std::vector<PatchVertex>& vertices,
                                 bool mirrored, MaterialIndex material) {
  TriangleMesh shared;
  shared.material = material;
  for (const PatchVertex& vertex : vertices) {
    shared.positions.push_back(vertex.position);
    if (!mesh.normals.empty()) shared.normals.push_back(vertex.normal);
  }
  for (const Vec2d& place : mesh.texture_points) {
    const bool is_usable = is_in_range(place.x) && is_in_range(place.y);
    shared.texture_points.push_back(is_usable ? place : Vec2d(0, 0));
  }
  std::vector<TriangleCorners> triangles;
  std::size_t begin = 0;
  for (const std::size_t end : mesh.ends) {
    positions_.clear();
    for (std::size_t k = begin; k < end; ++k) positions_.push_back(shared.positions[mesh.corners[k]]);
    const std::vector<TriangleIndices> cut = triangulate(positions_);
    skipped_ += cut.empty();
    for (const TriangleIndices& t : cut) {
      std::array<std::uint32_t, 3> at = {mesh.corners[begin + t[0]], mesh.corners[begin + t[1]],
                                         mesh.corners[begin + t[2]]};
      if (mirrored) std::swap(at[1], at[2]);
      triangles.push_back({.position = at, .normal = at, .texture_point = at});
    }
    begin = end;
  }
  count_polygons(triangles.size());
  if (!triangles.empty()) add_mesh(scene_, std::move(shared), triangles);
}

// The angle of modelling programs spans the picture, that of NFF the centres of its rows.
void ModelBuilder::add(const ModelCamera& camera, const ModelSpace& space) {
  if (scene_.view) return;
  View view;
  view.width = static_cast<int>(std::lround(std::clamp(view.height * camera.aspect, 1.0, 32768.0)));
  const double rows = view.height;
  view.angle_degrees = 2 * std::atan(camera.half_height * (rows - 1) / rows) * (180 / std::numbers::pi);
  if (std::isfinite(camera.near)) view.hither = std::max(camera.near, 0.0);
  camera_ = camera;
  aim(view, space.map);
  if (!is_usable(view)) {
    notes_.push_back("the camera '" + printable(camera.name) + "' has no perspective: left out");
    return;
  }
  camera_space_ = space;
  scene_.view = view;
}

// `map`: from the camera's node to the world.
void ModelBuilder::aim(View& view, const Affine& map) const {
  view.from = map.point(camera_.from);
  view.at = view.from + map.vector(camera_.direction).normalized();
  view.up = map.vector(camera_.up).normalized();
}

void ModelBuilder::add(Light light, const ModelSpace& space) {
  light.position = place_of(light, space.map);
  if (!is_in_range(light.position)) reject("a light's place is not finite, or beyond 1e100");
  if (light.is_sun && light.position == Vec3d(0, 0, 0)) {
    ++aimless_suns_;
    return;
  }
  scene_.lights.push_back(light);
  scene_.light_nodes.push_back({.node = space.node});
}

// Gives the camera a track in the world where its node moves. While its nodes flatten it, it looks as it does
// at the start.
void ModelBuilder::move_camera() {
  if (camera_space_.node == 0) return;
  const auto placed_at = [&](double time) {
    View view = *scene_.view;
    aim(view, placements_at(scene_.movement, time)[camera_space_.node].to_parent * camera_space_.map);
    return view;
  };
  const View start = placed_at(start_time(scene_.movement));
  if (!is_usable(start)) {
    notes_.push_back("the camera '" + printable(camera_.name) + "' is flattened by its nodes: left out");
    scene_.view.reset();
    return;
  }
  const auto view_at = [&](double time) {
    View view = placed_at(time);
    if (!is_usable(view)) view.at = view.from + (start.at - start.from), view.up = start.up;
    return view;
  };
  std::vector<double> times;
  for (NodeIndex n = camera_space_.node; n != 0; n = scene_.movement.nodes[n].parent) {
    const auto track = scene_.movement.tracks.find(scene_.movement.nodes[n].track);
    if (track == scene_.movement.tracks.end()) continue;
    const std::vector<double> own = key_times(track->second);
    times.insert(times.end(), own.begin(), own.end());
  }
  if (times.empty()) times.push_back(0);
  MotionTrack track = camera_track(std::move(times), view_at);
  scene_.view = start;
  scene_.movement.tracks[kCameraTrack] = std::move(track);
}

// A file may move nodes that hold nothing but a camera, or that it does not have.
void ModelBuilder::drop_unused_tracks() {
  std::set<std::string> used = {kCameraTrack};
  for (const SceneNode& node : scene_.movement.nodes) used.insert(node.track);
  std::erase_if(scene_.movement.tracks, [&](const auto& track) { return !used.contains(track.first); });
  if (scene_.movement.tracks.empty()) scene_.movement.times.reset();
}

ReadMesh ModelBuilder::finish(std::vector<std::string> files) && {
  note(skipped_, "point, line or face without extent left out",
       "points, lines and faces without extent left out");
  note(aimless_suns_, "sun without a direction: left out", "suns without a direction: left out");
  move_camera();
  drop_unused_tracks();
  return {without_resting_nodes(std::move(scene_)), std::move(notes_), std::move(files)};
}

}  // namespace pprt
