#include "convert/surfaces/material_meshes.h"

#include <array>
#include <span>

#include "scene/polygons/triangulate.h"

namespace pprt {
namespace {

// Makes every primitive a surface.
class MeshBuilder {
 public:
  MeshBuilder(const SceneDescription& scene, const Fineness& fineness) : scene_(scene), fineness_(fineness) {}

  MaterialMeshes run() {
    for (std::size_t place = 0; place < scene_.order.size(); ++place) {
      const PrimitiveRef ref = scene_.order[place];
      const Surface surface = surface_of(ref);
      if (surface.triangles.empty()) {
        ++degenerate_;
        continue;
      }
      MaterialMesh& mesh = meshes_[{node_of(scene_, place), material_of(scene_, ref)}];
      add(mesh, surface);
      if (ref.kind == PrimitiveKind::kTriangle) add_texture_points(mesh, scene_.triangles[ref.index]);
    }
    return std::move(meshes_);
  }

  std::size_t degenerate() const { return degenerate_; }

 private:
  Surface surface_of(PrimitiveRef ref) {
    switch (ref.kind) {
      case PrimitiveKind::kSphere:
        return curved(scene_.spheres[ref.index]);
      case PrimitiveKind::kCone:
        return curved(scene_.cones[ref.index]);
      case PrimitiveKind::kPolygon: {
        corners_.clear();
        for (const Vec3d& v : scene_.vertices(scene_.polygons[ref.index])) corners_.push_back({v, {0, 0, 0}});
        return facets();
      }
      case PrimitiveKind::kTriangle: {
        const std::array<PatchVertex, 3> corners = corners_of(scene_, scene_.triangles[ref.index]);
        corners_.assign(corners.begin(), corners.end());
        return facets();
      }
      case PrimitiveKind::kPatch:
      case PrimitiveKind::kMovingTriangle:
        break;
    }
    const std::span<const PatchVertex> vertices = scene_.vertices(scene_.patches[ref.index]);
    corners_.assign(vertices.begin(), vertices.end());
    return facets();
  }

  static void add(MaterialMesh& mesh, const Surface& surface) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const TriangleIndices& t : surface.triangles)
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }

  void add_texture_points(MaterialMesh& mesh, const Triangle& triangle) const {
    const TriangleMesh& from = scene_.meshes[triangle.mesh];
    if (from.texture_points.empty()) return;
    for (const std::uint32_t i : triangle.corners.texture_point)
      mesh.texture_points.push_back(from.texture_points[i]);
  }

  template <typename Curved>
  Surface curved(const Curved& object) const {
    const int n = divisions(object, fineness_);
    return n > 0 ? tessellate(object, n) : Surface();
  }

  // A vertex without a normal of its own gets the polygon's.
  Surface facets() {
    positions_.clear();
    for (const PatchVertex& v : corners_) positions_.push_back(v.position);
    Surface surface;
    surface.triangles = triangulate(positions_);
    if (surface.triangles.empty()) return surface;
    const Vec3d flat = newell_normal(positions_).normalized();
    for (PatchVertex& v : corners_) {
      v.normal.normalize();  // zero stays zero
      if (v.normal == Vec3d(0, 0, 0)) v.normal = flat;
    }
    surface.vertices = corners_;
    return surface;
  }

  const SceneDescription& scene_;
  const Fineness& fineness_;
  MaterialMeshes meshes_;
  std::size_t degenerate_ = 0;
  std::vector<PatchVertex> corners_;
  std::vector<Vec3d> positions_;
};

}  // namespace

MaterialMeshes material_meshes(const SceneDescription& scene, const Fineness& fineness,
                               std::size_t& degenerate) {
  MeshBuilder builder(scene, fineness);
  MaterialMeshes meshes = builder.run();
  degenerate = builder.degenerate();
  return meshes;
}

}  // namespace pprt
