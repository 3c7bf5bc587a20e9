#include "trace/connected_surfaces.h"

#include <bit>
#include <unordered_map>

#include "base/disjoint_sets.h"

namespace pprt {
namespace {

// Least cosine between the normals of one surface at a corner. Two and a half degrees are curvature, not an
// edge: what they change in a colour is interpolated.
constexpr float kLeastCosine = 0.999F;

struct Corner {
  Vec3f normal{0, 0, 0};
  std::uint32_t primitive = 0;
  MaterialIndex material = 0;
  std::uint32_t next = 0;  // of the same position
};

std::uint64_t hash_of(const Vec3f& position) {
  std::uint64_t hash = 0;
  for (int i = 0; i < 3; ++i) {
    hash ^= std::bit_cast<std::uint32_t>(position[i] + 0.0F);  // -0 equals 0
    hash *= 0x9E3779B97F4A7C15;
    hash ^= hash >> 29;
  }
  return hash;
}

void join_corners(const ScenePart& part, const Mesh& mesh, DisjointSets& sets) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::unordered_map<std::uint64_t, std::uint32_t> first;  // corner by the hash of its position
  first.reserve(mesh.triangles.size());
  std::vector<Corner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      const bool is_smooth = part.smooth && mesh.normals[vertex].dot(mesh.normals[vertex]) > 0;
      const Corner corner{is_smooth ? mesh.normals[vertex] : mesh.facets[i].normal, part.primitives[i] + 1,
                          part.materials[i], kNone};
      const auto number = static_cast<std::uint32_t>(corners.size());
      const auto [found, is_new] = first.try_emplace(hash_of(mesh.vertices[vertex]), number);
      corners.push_back(corner);
      if (is_new) continue;
      bool is_known = false;
      for (std::uint32_t k = found->second; k != kNone && !is_known; k = corners[k].next) {
        if (corners[k].material != corner.material || corners[k].normal.dot(corner.normal) < kLeastCosine)
          continue;
        sets.join(corners[k].primitive, corner.primitive);
        is_known = true;
      }
      if (is_known) continue;
      corners.back().next = found->second;
      found->second = number;
    }
  }
}

}  // namespace

std::vector<std::uint32_t> connected_surfaces(std::span<const ScenePart> parts, std::uint32_t primitives) {
  DisjointSets sets(primitives + 1);
  for (const ScenePart& part : parts) {
    const Mesh* mesh = std::get_if<Mesh>(&part.shape);
    if (mesh != nullptr && part.shapes.empty()) join_corners(part, *mesh, sets);
  }
  std::vector<std::uint32_t> surfaces(primitives + 1);
  for (std::uint32_t i = 0; i <= primitives; ++i) surfaces[i] = sets.find(i);
  return surfaces;
}

}  // namespace pprt
