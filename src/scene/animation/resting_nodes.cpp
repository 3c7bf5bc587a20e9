#include "scene/animation/resting_nodes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace pprt {
namespace {

// Where the space of a node stands in a node that is kept.
struct Base {
  NodeIndex node = 0;  // of the result
  Affine map;
};

// Returns the factor by which a map scales all lengths; 0 where it changes angles or mirrors.
double common_scale(const Affine& map) {
  constexpr double kRounding = 1e-12;
  const double scale = map.x.length();
  const double xy = map.x.dot(map.y), yz = map.y.dot(map.z), zx = map.z.dot(map.x);
  const double unequal = std::max({std::abs(map.y.length() - scale), std::abs(map.z.length() - scale)});
  const double askew = std::max({std::abs(xy), std::abs(yz), std::abs(zx)});
  const bool is_similar = unequal <= kRounding * scale && askew <= kRounding * scale * scale;
  return is_similar && map.determinant() > 0 ? scale : 0;
}

// Maps a normal. Where the map scales so much that it would be no number of a scene any more its length
// becomes 1.
Vec3d outward(const Affine& map, const Vec3d& normal) {
  constexpr double kMost = 1e50;
  const Vec3d mapped = map.outward(normal);
  const double length = mapped.length();
  return length > kMost || length < 1 / kMost ? mapped.normalized() : mapped;
}

class Settler {
 public:
  explicit Settler(SceneDescription& scene) : scene_(scene), mesh_maps_(scene.meshes.size()) {}

  void run() {
    settle_nodes();
    settle_lights();
    std::vector<NodeIndex> old = std::move(scene_.nodes);
    scene_.nodes.assign(scene_.order.size(), 0);
    for (std::size_t place = 0; place < scene_.order.size(); ++place) {
      node_ = old.empty() ? 0 : old[place];
      settle(place);
    }
    for (std::size_t i = 0; i < scene_.meshes.size(); ++i) move(scene_.meshes[i], mesh_maps_[i]);
    scene_.movement.nodes = std::move(kept_);
    const bool rests =
        std::all_of(scene_.nodes.begin(), scene_.nodes.end(), [](NodeIndex n) { return n == 0; });
    if (rests) scene_.nodes.clear();
  }

 private:
  static bool moves(const SceneNode& node) { return !node.track.empty(); }

  void settle_nodes() {
    for (const SceneNode& node : scene_.movement.nodes) {
      if (bases_.empty()) {
        bases_.push_back({});
        continue;
      }
      Base base = bases_[node.parent];
      if (moves(node)) {
        base = {keep(base), Affine()};
        kept_.push_back(
            {.parent = base.node, .to_parent = {}, .track = node.track, .location = node.location});
        base.node = static_cast<NodeIndex>(kept_.size() - 1);
      } else {
        base.map = base.map * node.to_parent;
      }
      bases_.push_back(base);
    }
  }

  // Returns a node of the result that stands as the base does.
  NodeIndex keep(const Base& base) {
    if (base.map == Affine()) return base.node;
    kept_.push_back({.parent = base.node, .to_parent = base.map, .track = {}, .location = {}});
    return static_cast<NodeIndex>(kept_.size() - 1);
  }

  void settle_lights() {
    for (std::size_t i = 0; i < scene_.light_nodes.size(); ++i) {
      LightNode& at = scene_.light_nodes[i];
      const Base& base = bases_[at.node];
      if (scene_.movement.tracks.contains(at.track)) {
        at.node = keep(base);
      } else {
        scene_.lights[i].position = place_of(scene_.lights[i], base.map);
        at = {.node = base.node};
      }
    }
    const bool rest = std::all_of(scene_.light_nodes.begin(), scene_.light_nodes.end(),
                                  [](const LightNode& at) { return at.node == 0 && at.track.empty(); });
    if (rest) scene_.light_nodes.clear();
  }

  void settle(std::size_t place) {
    const PrimitiveRef ref = scene_.order[place];
    const Base& base = bases_[node_];
    scene_.nodes[place] = base.node;
    // A mirrored surface keeps its front by the order of its vertices.
    const bool mirrors = base.map.determinant() < 0;
    switch (ref.kind) {
      case PrimitiveKind::kSphere: {
        Sphere& s = scene_.spheres[ref.index];
        const double scale = common_scale(base.map);
        if (scale == 0) return stay(place);
        s.center = base.map.point(s.center), s.radius *= scale;
        break;
      }
      case PrimitiveKind::kCone: {
        Cone& c = scene_.cones[ref.index];
        const double scale = common_scale(base.map);
        if (scale == 0) return stay(place);
        c.base = base.map.point(c.base), c.apex = base.map.point(c.apex);
        c.base_radius *= scale, c.apex_radius *= scale;
        break;
      }
      case PrimitiveKind::kPolygon: {
        const Polygon& p = scene_.polygons[ref.index];
        for (std::uint32_t i = 0; i < p.vertex_count; ++i) {
          Vec3d& v = scene_.polygon_vertices[p.first_vertex + i];
          v = base.map.point(v);
        }
        if (mirrors) reverse(p, scene_.polygon_vertices);
        break;
      }
      case PrimitiveKind::kPatch: {
        const Patch& p = scene_.patches[ref.index];
        for (std::uint32_t i = 0; i < p.vertex_count; ++i) {
          PatchVertex& v = scene_.patch_vertices[p.first_vertex + i];
          v = {base.map.point(v.position), outward(base.map, v.normal)};
        }
        if (mirrors) reverse(p, scene_.patch_vertices);
        break;
      }
      case PrimitiveKind::kTriangle:
        mesh_maps_[scene_.triangles[ref.index].mesh] = base.map;
        if (mirrors) turn(scene_.triangles[ref.index].corners);
        break;
      case PrimitiveKind::kMovingTriangle:
        for (MovingTriangle::Key& key : scene_.moving_triangles[ref.index].keys) {
          for (Vec3d& p : key.positions) p = base.map.point(p);
          for (Vec3d& n : key.normals) n = outward(base.map, n);
          if (mirrors)
            std::swap(key.positions[1], key.positions[2]), std::swap(key.normals[1], key.normals[2]);
        }
        break;
    }
  }

  template <typename Shape, typename Vertex>
  static void reverse(const Shape& shape, std::vector<Vertex>& vertices) {
    const auto first = vertices.begin() + shape.first_vertex;
    std::reverse(first, first + shape.vertex_count);
  }
  static void turn(TriangleCorners& corners) {
    for (auto* indices : {&corners.position, &corners.normal, &corners.texture_point})
      std::swap((*indices)[1], (*indices)[2]);
  }

  // All triangles of a mesh stand in one node.
  static void move(TriangleMesh& mesh, const Affine& map) {
    if (map == Affine()) return;
    for (Vec3d& p : mesh.positions) p = map.point(p);
    for (Vec3d& n : mesh.normals) n = outward(map, n);
  }

  // A primitive that the resting node's map would turn into another kind.
  void stay(std::size_t place) {
    const auto [found, is_new] = stretched_.try_emplace(node_, NodeIndex{0});
    if (is_new) found->second = keep(bases_[node_]);
    scene_.nodes[place] = found->second;
  }

  SceneDescription& scene_;
  std::vector<Base> bases_;                   // of the nodes before
  std::vector<SceneNode> kept_ = {{}};        // of the result
  std::map<NodeIndex, NodeIndex> stretched_;  // nodes that are kept for spheres and cones
  std::vector<Affine> mesh_maps_;
  NodeIndex node_ = 0;  // of the primitive at hand
};

}  // namespace

SceneDescription without_resting_nodes(SceneDescription scene) {
  Settler(scene).run();
  return scene;
}

namespace {

// A triangle without movement, and a mesh of its own.
void add_still(SceneDescription& scene, const MovingTriangle& triangle, double time) {
  const MovingTriangle::Key shape = shape_at(triangle, time);
  TriangleMesh mesh{.positions = {shape.positions.begin(), shape.positions.end()},
                    .normals = {shape.normals.begin(), shape.normals.end()},
                    .texture_points = {},
                    .material = triangle.material,
                    .location = triangle.location};
  const TriangleCorners corners{.position = {0, 1, 2}, .normal = {0, 1, 2}, .texture_point = {}};
  add_mesh(scene, std::move(mesh), {&corners, 1});
}

}  // namespace

SceneDescription with_still_triangles(SceneDescription scene, double time) {
  const std::vector<PrimitiveRef> order = std::exchange(scene.order, {});
  for (const PrimitiveRef ref : order) {
    if (ref.kind == PrimitiveKind::kMovingTriangle) {
      add_still(scene, scene.moving_triangles[ref.index], time);
    } else {
      scene.order.push_back(ref);
    }
  }
  scene.moving_triangles.clear();
  return scene;
}

SceneDescription still_at(SceneDescription scene, double time) {
  scene = with_still_triangles(std::move(scene), time);
  const std::vector<Placement> placements = placements_at(scene.movement, time);
  scene.view = view_at(scene, time);
  for (std::size_t i = 0; i < scene.light_nodes.size(); ++i) {
    if (const auto moved = track_at(scene.movement, scene.light_nodes[i].track, time))
      scene.lights[i].position = moved->to_parent.origin;
    scene.light_nodes[i].track.clear();
  }
  const std::vector<PrimitiveRef> order = std::exchange(scene.order, {});
  const std::vector<NodeIndex> nodes = std::exchange(scene.nodes, {});
  for (std::size_t place = 0; place < order.size(); ++place) {
    const NodeIndex node = nodes.empty() ? 0 : nodes[place];
    if (!placements[node].visible) continue;
    scene.order.push_back(order[place]);
    scene.nodes.push_back(node);
  }
  for (std::size_t i = 1; i < placements.size(); ++i)
    scene.movement.nodes[i] = {
        .parent = 0, .to_parent = placements[i].to_parent, .track = {}, .location = {}};
  scene.movement.tracks.clear();
  scene.movement.times.reset();
  return without_resting_nodes(std::move(scene));
}

}  // namespace pprt
