#include "scene/description/scene_description.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/hash.h"

namespace pprt {
namespace {

constexpr MaterialIndex kEmpty = ~MaterialIndex{0};

std::size_t hash(const Material& m) {
  const double values[] = {m.color.x,  m.color.y, m.color.z,       m.diffuse,
                           m.specular, m.shine,   m.transmittance, m.refractive_index};
  std::uint64_t h = 0;
  // -0 equals 0 and must have the same hash.
  const auto add = [&h](double v) { h = mixed(h, std::bit_cast<std::uint64_t>(v + 0.0)); };
  for (const double v : values) add(v);
  if (m.terms) {
    for (const Rgb& c : {m.terms->ambient, m.terms->diffuse, m.terms->specular}) add(c.x), add(c.y), add(c.z);
  }
  for (const double v : {m.emission.x, m.emission.y, m.emission.z}) add(v);
  if (m.texture) add(*m.texture);
  if (m.emission_texture) add(*m.emission_texture);
  return static_cast<std::size_t>(h);
}

// Returns what `read` returns for the primitive.
template <typename Read>
auto of_primitive(const SceneDescription& scene, PrimitiveRef ref, const Read& read) {
  switch (ref.kind) {
    case PrimitiveKind::kSphere:
      return read(scene.spheres[ref.index]);
    case PrimitiveKind::kCone:
      return read(scene.cones[ref.index]);
    case PrimitiveKind::kPolygon:
      return read(scene.polygons[ref.index]);
    case PrimitiveKind::kPatch:
      return read(scene.patches[ref.index]);
    case PrimitiveKind::kTriangle:
      return read(scene.meshes[scene.triangles[ref.index].mesh]);
    case PrimitiveKind::kMovingTriangle:
      break;
  }
  return read(scene.moving_triangles[ref.index]);
}

// Returns the half extent of a disc along each axis i: radius * sqrt(1 - n_i^2), with n the unit normal.
Vec3d disc_half_extent(const Vec3d& unit_normal, double radius) {
  Vec3d half;
  for (int i = 0; i < 3; ++i) {
    half[i] = std::abs(radius) * std::sqrt(std::max(0.0, 1 - unit_normal[i] * unit_normal[i]));
  }
  return half;
}

void extend_by_disc(Box3d& box, const Vec3d& center, const Vec3d& half) {
  box.extendBy(center - half);
  box.extendBy(center + half);
}

}  // namespace

void add_sphere(SceneDescription& scene, const Sphere& sphere) {
  scene.order.push_back({PrimitiveKind::kSphere, static_cast<std::uint32_t>(scene.spheres.size())});
  scene.spheres.push_back(sphere);
}

void add_cone(SceneDescription& scene, const Cone& cone) {
  scene.order.push_back({PrimitiveKind::kCone, static_cast<std::uint32_t>(scene.cones.size())});
  scene.cones.push_back(cone);
}

void add_polygon(SceneDescription& scene, std::span<const Vec3d> vertices, MaterialIndex material,
                 SourceLocation location) {
  scene.order.push_back({PrimitiveKind::kPolygon, static_cast<std::uint32_t>(scene.polygons.size())});
  scene.polygons.push_back({static_cast<std::uint32_t>(scene.polygon_vertices.size()),
                            static_cast<std::uint32_t>(vertices.size()), material, location});
  scene.polygon_vertices.insert(scene.polygon_vertices.end(), vertices.begin(), vertices.end());
}

void add_patch(SceneDescription& scene, std::span<const PatchVertex> vertices, MaterialIndex material,
               SourceLocation location) {
  scene.order.push_back({PrimitiveKind::kPatch, static_cast<std::uint32_t>(scene.patches.size())});
  scene.patches.push_back({static_cast<std::uint32_t>(scene.patch_vertices.size()),
                           static_cast<std::uint32_t>(vertices.size()), material, location});
  scene.patch_vertices.insert(scene.patch_vertices.end(), vertices.begin(), vertices.end());
}

void add_mesh(SceneDescription& scene, TriangleMesh mesh, std::span<const TriangleCorners> triangles) {
  const auto index = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  for (const TriangleCorners& corners : triangles) {
    scene.order.push_back({PrimitiveKind::kTriangle, static_cast<std::uint32_t>(scene.triangles.size())});
    scene.triangles.push_back({index, corners});
  }
}

void add_moving_triangle(SceneDescription& scene, MovingTriangle triangle) {
  scene.order.push_back(
      {PrimitiveKind::kMovingTriangle, static_cast<std::uint32_t>(scene.moving_triangles.size())});
  scene.moving_triangles.push_back(std::move(triangle));
}

MaterialIndex MaterialTable::intern(std::vector<Material>& materials, const Material& material) {
  if (2 * (used_ + 1) > slots_.size()) {
    // At most half full, also when the first call finds many materials.
    slots_.assign(std::bit_ceil(std::max<std::size_t>(16, 4 * materials.size())), kEmpty);
    for (MaterialIndex i = 0; i < materials.size(); ++i) {
      std::size_t slot = hash(materials[i]) & (slots_.size() - 1);
      while (slots_[slot] != kEmpty) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = i;
    }
    used_ = materials.size();
  }
  std::size_t slot = hash(material) & (slots_.size() - 1);
  for (; slots_[slot] != kEmpty; slot = (slot + 1) & (slots_.size() - 1)) {
    if (materials[slots_[slot]] == material) return slots_[slot];
  }
  slots_[slot] = static_cast<MaterialIndex>(materials.size());
  materials.push_back(material);
  ++used_;
  return slots_[slot];
}

std::array<PatchVertex, 3> corners_of(const SceneDescription& scene, const Triangle& triangle) {
  const TriangleMesh& mesh = scene.meshes[triangle.mesh];
  std::array<PatchVertex, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i].position = mesh.positions[triangle.corners.position[i]];
    if (!mesh.normals.empty()) corners[i].normal = mesh.normals[triangle.corners.normal[i]];
  }
  return corners;
}

Vec3d place_of(const Light& light, const Affine& map) {
  if (!light.is_sun) return map.point(light.position);
  const Vec3d turned = map.vector(light.position);
  const double largest = std::max({std::abs(turned.x), std::abs(turned.y), std::abs(turned.z)});
  return largest > 0 && std::isfinite(turned.x + turned.y + turned.z) ? turned : light.position;
}

SourceLocation location_of(const SceneDescription& scene, PrimitiveRef ref) {
  return of_primitive(scene, ref, [](const auto& primitive) { return primitive.location; });
}

MaterialIndex material_of(const SceneDescription& scene, PrimitiveRef ref) {
  return of_primitive(scene, ref, [](const auto& primitive) { return primitive.material; });
}

// Without keys of one kind, what the view itself says stays.
std::optional<View> view_at(const SceneDescription& scene, double time) {
  std::optional<View> view = scene.view;
  const auto camera = scene.movement.tracks.find(kCameraTrack);
  if (!view || camera == scene.movement.tracks.end()) return view;
  const Affine map = placement_at(camera->second, time).to_parent;
  const Vec3d direction = camera->second.rotation.empty() ? view->at - view->from : -map.z.normalized();
  if (!camera->second.rotation.empty()) view->up = map.y.normalized();
  if (!camera->second.translation.empty()) view->from = map.origin;
  view->at = view->from + direction;
  return view;
}

MovingTriangle::Key shape_at(const MovingTriangle& triangle, double time) {
  const auto& keys = triangle.keys;
  const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                      [](double t, const MovingTriangle::Key& key) { return t < key.time; });
  MovingTriangle::Key shape = after == keys.end() ? keys.back() : *after;
  if (after != keys.begin() && after != keys.end()) {
    const MovingTriangle::Key& before = *(after - 1);
    const double share = (time - before.time) / (after->time - before.time);
    for (std::size_t i = 0; i < 3; ++i) {
      shape.positions[i] = before.positions[i] * (1 - share) + after->positions[i] * share;
      shape.normals[i] = before.normals[i] * (1 - share) + after->normals[i] * share;
    }
  }
  shape.time = time;
  for (Vec3d& normal : shape.normals) normal.normalize();
  return shape;
}

Box3d bounds(const SceneDescription& scene, PrimitiveRef ref) {
  Box3d box;
  switch (ref.kind) {
    case PrimitiveKind::kSphere: {
      const Sphere& s = scene.spheres[ref.index];
      extend_by_disc(box, s.center, Vec3d(std::abs(s.radius)));
      break;
    }
    case PrimitiveKind::kCone: {
      const Cone& c = scene.cones[ref.index];
      const Vec3d axis = (c.apex - c.base).normalized();
      extend_by_disc(box, c.base, disc_half_extent(axis, c.base_radius));
      extend_by_disc(box, c.apex, disc_half_extent(axis, c.apex_radius));
      break;
    }
    case PrimitiveKind::kPolygon:
      for (const Vec3d& v : scene.vertices(scene.polygons[ref.index])) box.extendBy(v);
      break;
    case PrimitiveKind::kPatch:
      for (const PatchVertex& v : scene.vertices(scene.patches[ref.index])) box.extendBy(v.position);
      break;
    case PrimitiveKind::kTriangle: {
      const Triangle& t = scene.triangles[ref.index];
      for (const std::uint32_t i : t.corners.position) box.extendBy(scene.meshes[t.mesh].positions[i]);
      break;
    }
    case PrimitiveKind::kMovingTriangle:
      for (const MovingTriangle::Key& key : scene.moving_triangles[ref.index].keys) {
        for (const Vec3d& p : key.positions) box.extendBy(p);
      }
      break;
  }
  return box;
}

Box3d bounds(const SceneDescription& scene) {
  Box3d box;
  for (const PrimitiveRef ref : scene.order) box.extendBy(bounds(scene, ref));
  return box;
}

}  // namespace pprt
