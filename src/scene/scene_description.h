// The contents of a scene file as plain values in the file's own units. Nothing is compiled, tessellated or
// rounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/source_location.h"
#include "base/vector.h"

namespace pprt {

// Colour as a scene file gives it, nominally in [0, 1]. Doubles, so that it is written back as it was read.
using Rgb = Imath::Color3<double>;

// NFF "f": local shading (Lambert, Phong) and the weights of reflected and refracted rays.
struct Material {
  Rgb color{1, 1, 1};
  double diffuse = 1;           // Kd
  double specular = 0;          // Ks: highlight, and weight of the reflected ray
  double shine = 0;             // Phong exponent; 0 or Ks = 0: no highlight
  double transmittance = 0;     // T: weight of the refracted ray; > 0 makes the surface two-sided
  double refractive_index = 1;  // meaningless (often 0) on opaque materials

  friend bool operator==(const Material&, const Material&) = default;
};

// NFF "l": positional, without attenuation.
struct Light {
  Vec3d position{0, 0, 0};
  std::optional<Rgb> color;  // absent: white, and written back without a colour
  SourceLocation location;
};

// NFF "v". The angle spans the centres of the first and last pixel, across rows and columns alike (SPD's
// aspect ratio 1). No vector is normalised.
struct View {
  Vec3d from{0, 0, 0};
  Vec3d at{0, 0, 1};
  Vec3d up{0, 1, 0};
  double angle_degrees = 45;
  double hither = 0;  // distance of the near plane; kept for writing, not used for clipping
  int width = 512;
  int height = 512;
  SourceLocation location;
};

using MaterialIndex = std::uint32_t;  // into SceneDescription::materials

// NFF "s". Negative radius: only the inside is visible.
struct Sphere {
  Vec3d center{0, 0, 0};
  double radius = 0;
  MaterialIndex material = 0;
  SourceLocation location;
};

// NFF "c": open cone or cylinder without end caps. Both radii negative: only the inside is visible.
struct Cone {
  Vec3d base{0, 0, 0};
  double base_radius = 0;
  Vec3d apex{0, 0, 0};
  double apex_radius = 0;
  MaterialIndex material = 0;
  SourceLocation location;
};

// NFF "p": counter-clockwise seen from the front, nominally planar, possibly concave. Its vertices are
// SceneDescription::polygon_vertices[first_vertex .. first_vertex + vertex_count).
struct Polygon {
  std::uint32_t first_vertex = 0;
  std::uint32_t vertex_count = 0;
  MaterialIndex material = 0;
  SourceLocation location;
};

// A vertex of a patch.
struct PatchVertex {
  Vec3d position{0, 0, 0};
  Vec3d normal{0, 0, 0};  // as given, not necessarily of unit length
};

// NFF "pp": a polygon with a normal per vertex.
// Its vertices are SceneDescription::patch_vertices[first_vertex .. first_vertex + vertex_count).
struct Patch {
  std::uint32_t first_vertex = 0;
  std::uint32_t vertex_count = 0;
  MaterialIndex material = 0;
  SourceLocation location;
};

enum class PrimitiveKind : std::uint8_t { kSphere, kCone, kPolygon, kPatch };

// Refers to the index-th object of its kind.
struct PrimitiveRef {
  PrimitiveKind kind = PrimitiveKind::kSphere;
  std::uint32_t index = 0;

  friend bool operator==(const PrimitiveRef&, const PrimitiveRef&) = default;
};

// A whole scene. Invariant: all material, vertex and primitive indices are in range.
struct SceneDescription {
  std::string name;               // file name or "spd:tree:11", for messages
  std::optional<Rgb> background;  // absent: black
  std::optional<View> view;
  std::vector<Light> lights;
  std::vector<Material> materials;  // distinct
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
  std::vector<Polygon> polygons;
  std::vector<Patch> patches;
  std::vector<Vec3d> polygon_vertices;
  std::vector<PatchVertex> patch_vertices;
  std::vector<PrimitiveRef> order;  // every primitive once, in file order

  // Each returns the vertices of a polygon or patch of this scene.
  std::span<const Vec3d> vertices(const Polygon& polygon) const {
    return std::span(polygon_vertices).subspan(polygon.first_vertex, polygon.vertex_count);
  }
  std::span<const PatchVertex> vertices(const Patch& patch) const {
    return std::span(patch_vertices).subspan(patch.first_vertex, patch.vertex_count);
  }
  std::size_t primitive_count() const { return order.size(); }
};

// Each appends a primitive and its entry in `order`. `material` must be in range.
void add_sphere(SceneDescription& scene, const Sphere& sphere);
void add_cone(SceneDescription& scene, const Cone& cone);
void add_polygon(SceneDescription& scene, std::span<const Vec3d> vertices, MaterialIndex material,
                 SourceLocation location = {});
void add_patch(SceneDescription& scene, std::span<const PatchVertex> vertices, MaterialIndex material,
               SourceLocation location = {});

// Returns the material of a primitive; `ref` must be in range.
MaterialIndex material_of(const SceneDescription& scene, PrimitiveRef ref);

// Returns where a primitive stands in its file; line 0 if it comes from none. `ref` must be in range.
SourceLocation location_of(const SceneDescription& scene, PrimitiveRef ref);

// Gives equal materials one index: a file with thousands of "f" lines but four distinct ones keeps four.
class MaterialTable {
 public:
  // Returns the index of `material` in `materials` and appends it when it is new. Amortised constant time.
  MaterialIndex intern(std::vector<Material>& materials, const Material& material);

 private:
  std::vector<MaterialIndex> slots_;  // open addressing; kEmpty marks a free slot
  std::size_t used_ = 0;
};

// Returns the axis-parallel bounding box of a primitive, exact for cones and spheres too. `ref` must be in
// range.
Box3d bounds(const SceneDescription& scene, PrimitiveRef ref);

// Returns the bounding box of all primitives; empty when there are none.
Box3d bounds(const SceneDescription& scene);

}  // namespace pprt
