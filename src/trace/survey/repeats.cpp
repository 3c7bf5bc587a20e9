#include "trace/survey/repeats.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "base/hash.h"

namespace pprt {
namespace {

// Mixes numbers into 64 bits. Equal numbers, 0 and -0 among them, give equal bits.
class Mixer {
 public:
  void add(std::uint64_t word) { state_ = mixed(state_, word); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value + 0.0)); }
  void add(const Vec3d& v) { add(v.x), add(v.y), add(v.z); }
  void add(const PatchVertex& v) { add(v.position), add(v.normal); }
  std::uint64_t bits() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

bool same(const PatchVertex& a, const PatchVertex& b) {
  return a.position == b.position && a.normal == b.normal;
}

struct MeshVertex {
  Vec3d position{0, 0, 0}, normal{0, 0, 0};
  Vec2d texture_point{0, 0};

  friend bool operator==(const MeshVertex&, const MeshVertex&) = default;
};

// Open addressing over places in the scene's order.
class PrimitiveSet {
 public:
  explicit PrimitiveSet(const SceneDescription& scene)
      : scene_(scene), slots_(std::bit_ceil(2 * scene.order.size() + 1), kEmpty) {}

  // Adds a primitive; returns false when an equal one is in the set.
  bool add(std::uint32_t place) {
    const PrimitiveRef ref = scene_.order[place];
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash(ref, place) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == kEmpty) {
        slots_[slot] = place;
        return true;
      }
      if (node_of(scene_, slots_[slot]) == node_of(scene_, place) && equal(scene_.order[slots_[slot]], ref))
        return false;
    }
  }

 private:
  static constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();

  std::uint64_t hash(PrimitiveRef ref, std::size_t place) const {
    Mixer mixer;
    mixer.add(static_cast<std::uint64_t>(ref.kind) << 32 | material_of(scene_, ref));
    mixer.add(static_cast<std::uint64_t>(node_of(scene_, place)));
    switch (ref.kind) {
      case PrimitiveKind::kSphere: {
        const Sphere& s = scene_.spheres[ref.index];
        mixer.add(s.center), mixer.add(s.radius);
        break;
      }
      case PrimitiveKind::kCone: {
        const Cone& c = scene_.cones[ref.index];
        mixer.add(c.base), mixer.add(c.base_radius), mixer.add(c.apex), mixer.add(c.apex_radius);
        break;
      }
      case PrimitiveKind::kPolygon:
        for (const Vec3d& v : scene_.vertices(scene_.polygons[ref.index])) mixer.add(v);
        break;
      case PrimitiveKind::kPatch:
        for (const PatchVertex& v : scene_.vertices(scene_.patches[ref.index])) mixer.add(v);
        break;
      case PrimitiveKind::kTriangle:
        for (const MeshVertex& v : vertices(scene_.triangles[ref.index])) mixer.add(v.position);
        break;
      case PrimitiveKind::kMovingTriangle:
        mixer.add(static_cast<std::uint64_t>(ref.index));
        break;
    }
    return mixer.bits();
  }

  bool equal(PrimitiveRef a, PrimitiveRef b) const {
    if (a.kind != b.kind || material_of(scene_, a) != material_of(scene_, b)) return false;
    switch (a.kind) {
      case PrimitiveKind::kSphere: {
        const Sphere &s = scene_.spheres[a.index], &t = scene_.spheres[b.index];
        return s.center == t.center && s.radius == t.radius;
      }
      case PrimitiveKind::kCone: {
        const Cone &c = scene_.cones[a.index], &d = scene_.cones[b.index];
        return c.base == d.base && c.apex == d.apex && c.base_radius == d.base_radius &&
               c.apex_radius == d.apex_radius;
      }
      case PrimitiveKind::kPolygon:
        return std::ranges::equal(scene_.vertices(scene_.polygons[a.index]),
                                  scene_.vertices(scene_.polygons[b.index]));
      case PrimitiveKind::kPatch:
        return std::ranges::equal(scene_.vertices(scene_.patches[a.index]),
                                  scene_.vertices(scene_.patches[b.index]), same);
      case PrimitiveKind::kTriangle:
        return vertices(scene_.triangles[a.index]) == vertices(scene_.triangles[b.index]);
      case PrimitiveKind::kMovingTriangle:
        return false;  // with all their keys they are hardly ever equal
    }
    return false;
  }

  std::array<MeshVertex, 3> vertices(const Triangle& triangle) const {
    const TriangleMesh& mesh = scene_.meshes[triangle.mesh];
    const TriangleCorners& at = triangle.corners;
    std::array<MeshVertex, 3> all;
    for (std::size_t i = 0; i < 3; ++i) {
      all[i].position = mesh.positions[at.position[i]];
      if (!mesh.normals.empty()) all[i].normal = mesh.normals[at.normal[i]];
      if (!mesh.texture_points.empty()) all[i].texture_point = mesh.texture_points[at.texture_point[i]];
    }
    return all;
  }

  const SceneDescription& scene_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace

Repeats find_repeats(const SceneDescription& scene) {
  Repeats repeats;
  PrimitiveSet seen(scene);
  for (std::uint32_t place = 0; place < scene.order.size(); ++place) {
    if (seen.add(place)) continue;
    if (repeats.count++ == 0) {
      repeats.first = place;
      repeats.repeated.assign(scene.order.size(), false);
    }
    repeats.repeated[place] = true;
  }
  return repeats;
}

}  // namespace pprt
