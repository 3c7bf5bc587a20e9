#include "trace/parts_builder.h"

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "trace/geometry/numerics.h"
#include "trace/survey/repeats.h"

namespace pprt {
namespace {

class PartsBuilder {
 public:
  PartsBuilder(const SceneDescription& scene, CompiledScene::Impl& impl) : scene_(scene), impl_(impl) {}

  void run() {
    repeats_ = find_repeats(scene_);
    impl_.figures.repeated = repeats_.count;
    impl_.figures.first_repeated = repeats_.first;
    find_bodies();
    for (body_ = 0; body_ < impl_.bodies.size(); ++body_) {
      first_part_ = impl_.parts.size();
      normalise();
      for (const PrimitiveKind kind :
           {PrimitiveKind::kSphere, PrimitiveKind::kCone, PrimitiveKind::kPolygon, PrimitiveKind::kPatch,
            PrimitiveKind::kTriangle, PrimitiveKind::kMovingTriangle}) {
        for (const std::uint32_t place : places_[body_]) {
          if (scene_.order[place].kind == kind) add(place);
        }
      }
    }
  }

 private:
  // One body for each node, and another for what changes its shape there. The first is what rests.
  void find_bodies() {
    std::map<std::pair<NodeIndex, bool>, std::size_t> bodies = {{{0, false}, 0}};
    impl_.bodies.emplace_back();
    places_.emplace_back();
    for (std::uint32_t place = 0; place < scene_.order.size(); ++place) {
      if (repeats_.count > 0 && repeats_.repeated[place]) continue;
      const NodeIndex node = node_of(scene_, place);
      const bool deforms = scene_.order[place].kind == PrimitiveKind::kMovingTriangle;
      const auto [found, is_new] = bodies.try_emplace({node, deforms}, impl_.bodies.size());
      if (is_new) {
        CompiledBody& body = impl_.bodies.emplace_back();
        body.node = node, body.deforms = deforms;
        places_.emplace_back();
      }
      places_[found->second].push_back(place);
    }
  }

  void normalise() {
    CompiledBody& body = impl_.bodies[body_];
    if (body_ == 0) {
      body.normalisation = impl_.normalisation;
      return;
    }
    Box3d box;
    for (const std::uint32_t place : places_[body_]) {
      const Box3d own = bounds(scene_, scene_.order[place]);
      require(own.isEmpty() || (is_finite(own.min) && is_finite(own.max)),
              location_of(scene_, scene_.order[place]));
      box.extendBy(own);
    }
    body.normalisation = normalising(box);
    body.box = {body.normalisation.point(box.min), body.normalisation.point(box.max)};
  }

  void add(std::uint32_t place) {
    place_ = place;
    const PrimitiveRef ref = scene_.order[place];
    switch (ref.kind) {
      case PrimitiveKind::kSphere:
        return add(scene_.spheres[ref.index]);
      case PrimitiveKind::kCone:
        return add(scene_.cones[ref.index]);
      case PrimitiveKind::kPolygon:
        return add(scene_.polygons[ref.index]);
      case PrimitiveKind::kPatch:
        return add(scene_.patches[ref.index]);
      case PrimitiveKind::kTriangle:
        return add(scene_.triangles[ref.index]);
      case PrimitiveKind::kMovingTriangle:
        return add(scene_.moving_triangles[ref.index]);
    }
  }

  const Normalisation& space() const { return impl_.bodies[body_].normalisation; }

  VisibleFaces faces(MaterialIndex material, bool inside_only) const {
    if (inside_only) return VisibleFaces::kBack;
    const bool opaque = !(scene_.materials[material].transmittance > 0);
    return impl_.options.cull && opaque ? VisibleFaces::kFront : VisibleFaces::kBoth;
  }

  // What tells the parts of a body apart.
  struct PartKey {
    PrimitiveKind kind;
    VisibleFaces faces;
    bool smooth = false, textured = false;
  };

  // Linear search: a body has few parts.
  template <class Shape>
  std::pair<ScenePart&, Shape&> part(const PartKey& key) {
    for (std::size_t i = first_part_; i < impl_.parts.size(); ++i) {
      ScenePart& p = impl_.parts[i];
      if (p.kind == key.kind && p.faces == key.faces && p.smooth == key.smooth && p.textured == key.textured)
        return {p, std::get<Shape>(p.shape)};
    }
    ScenePart& p = impl_.parts.emplace_back();
    p.kind = key.kind, p.faces = key.faces, p.smooth = key.smooth, p.textured = key.textured;
    p.body = static_cast<std::uint32_t>(body_);
    return {p, p.shape.emplace<Shape>()};
  }

  void add(const Sphere& s) {
    require(is_finite(s.center) && std::isfinite(s.radius), s.location);
    if (s.radius == 0) return drop();
    auto [to, shape] =
        part<std::vector<SphereRecord>>({PrimitiveKind::kSphere, faces(s.material, s.radius < 0)});
    shape.push_back({space().point(s.center), space().length(std::abs(s.radius))});
    finish(to, 1, s.material);
  }

  void add(const Cone& c) {
    require(is_finite(c.base) && is_finite(c.apex) && std::isfinite(c.base_radius + c.apex_radius),
            c.location);
    const double base_radius = space().length(std::abs(c.base_radius));
    const double apex_radius = space().length(std::abs(c.apex_radius));
    const Vec3d axis = (c.apex - c.base) * space().scale;
    if (axis.dot(axis) == 0 || (base_radius == 0 && apex_radius == 0)) return drop();
    const bool inside_only = c.base_radius < 0 || c.apex_radius < 0;
    auto [to, shape] = part<std::vector<ConeRecord>>({PrimitiveKind::kCone, faces(c.material, inside_only)});
    shape.push_back({space().point(c.base), axis, base_radius, apex_radius - base_radius});
    finish(to, 1, c.material);
  }

  void add(const Polygon& p) {
    positions_.clear();
    for (const Vec3d& v : scene_.vertices(p)) {
      require(is_finite(v), p.location);
      positions_.push_back(space().point(v));
    }
    auto [to, mesh] = part<Mesh>({PrimitiveKind::kPolygon, faces(p.material, false)});
    finish_mesh(to, mesh.add(positions_, {}), p.material);
  }

  void add(const Patch& p) {
    positions_.clear();
    normals_.clear();
    for (const PatchVertex& v : scene_.vertices(p)) {
      require(is_finite(v.position) && is_finite(v.normal), p.location);
      positions_.push_back(space().point(v.position));
      normals_.emplace_back(v.normal.normalized());  // a zero normal stays zero
    }
    auto [to, mesh] = part<Mesh>({PrimitiveKind::kPatch, faces(p.material, false), true});
    finish_mesh(to, mesh.add(positions_, normals_), p.material);
  }

  void add(const Triangle& t) {
    const TriangleMesh& from = scene_.meshes[t.mesh];
    const bool smooth = !from.normals.empty(), textured = !from.texture_points.empty();
    positions_.clear();
    normals_.clear();
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d& position = from.positions[t.corners.position[i]];
      require(is_finite(position), from.location);
      positions_.push_back(space().point(position));
      if (!smooth) continue;
      const Vec3d& normal = from.normals[t.corners.normal[i]];
      require(is_finite(normal), from.location);
      normals_.emplace_back(normal.normalized());
    }
    auto [to, mesh] = part<Mesh>({PrimitiveKind::kTriangle, faces(from.material, false), smooth, textured});
    const std::size_t added = mesh.add(positions_, normals_);
    if (textured && added > 0) {
      for (const std::uint32_t i : t.corners.texture_point)
        mesh.texture_points.emplace_back(from.texture_points[i]);
    }
    finish_mesh(to, added, from.material);
  }

  // The pose of each time gives it its shape.
  void add(const MovingTriangle& t) {
    MovingTriangle shape = t;
    for (MovingTriangle::Key& key : shape.keys) {
      for (std::size_t i = 0; i < 3; ++i) {
        require(is_finite(key.positions[i]) && is_finite(key.normals[i]), t.location);
        key.positions[i] = space().point(key.positions[i]);
      }
    }
    auto [to, mesh] = part<Mesh>({PrimitiveKind::kMovingTriangle, faces(t.material, false), true});
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.resize(first + 3);
    mesh.normals.resize(first + 3);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.facets.emplace_back();
    to.shapes.push_back(std::move(shape));
    finish_mesh(to, 1, t.material);
  }

  // `count`: number of Embree primitives, 1 or the number of triangles.
  void finish(ScenePart& to, std::size_t count, MaterialIndex material) const {
    to.materials.insert(to.materials.end(), count, material);
    to.primitives.insert(to.primitives.end(), count, place_);
  }

  void finish_mesh(ScenePart& to, std::size_t triangles, MaterialIndex material) {
    if (triangles == 0) return drop();
    finish(to, triangles, material);
    impl_.figures.triangles += triangles;
  }

  void require(bool finite, SourceLocation at) const {
    if (finite) return;
    const std::string place =
        at.line > 0 ? scene_.name + ":" + std::to_string(at.line) + ":" + std::to_string(at.column)
                    : scene_.name;
    throw InputError(place + ": error: a coordinate or radius is not finite");
  }

  void drop() { ++impl_.figures.degenerate; }

  const SceneDescription& scene_;
  CompiledScene::Impl& impl_;
  Repeats repeats_;
  std::vector<std::vector<std::uint32_t>> places_;  // in the description's order, by body
  std::size_t body_ = 0;                            // at hand
  std::size_t first_part_ = 0;                      // of that body
  std::uint32_t place_ = 0;  // in the description's order, of the primitive that is being added
  std::vector<Vec3d> positions_;
  std::vector<Vec3f> normals_;
};

}  // namespace

void build_parts(const SceneDescription& scene, CompiledScene::Impl& impl) {
  PartsBuilder(scene, impl).run();
}

}  // namespace pprt
