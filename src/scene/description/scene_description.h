// The contents of a scene file as plain values in the file's own units. Nothing is compiled, tessellated or
// rounded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/source_location.h"
#include "base/vector.h"
#include "scene/description/texture.h"
#include "scene/movement/movement.h"

namespace pprt {

// Colour as a scene file gives it, nominally in [0, 1]. Doubles, so that it is written back as it was read.
using Rgb = Imath::Color3<double>;

// A colour for each term of a material (AFF "fm").
struct TermColors {
  Rgb ambient{0, 0, 0};   // times the scene's ambient light
  Rgb diffuse{1, 1, 1};   // in place of colour times Kd
  Rgb specular{0, 0, 0};  // in place of Ks

  friend bool operator==(const TermColors&, const TermColors&) = default;
};

// NFF "f": local shading (Lambert, Phong) and the weights of reflected and refracted rays.
struct Material {
  Rgb color{1, 1, 1};
  double diffuse = 1;           // Kd
  double specular = 0;          // Ks: highlight, and weight of the reflected ray
  double shine = 0;             // Phong exponent; 0 or Ks = 0: no highlight
  double transmittance = 0;     // T: weight of the refracted ray; > 0 makes the surface two-sided
  double refractive_index = 1;  // meaningless (often 0) on opaque materials
  // Not in NFF. With terms, colour and Kd mean nothing, and Ks is the largest component of the specular one.
  std::optional<TermColors> terms = {};
  std::optional<TextureIndex> texture = {};           // times the ambient and the diffuse term
  Rgb emission{0, 0, 0};                              // light that it gives off, the same in all directions
  std::optional<TextureIndex> emission_texture = {};  // times the emission, at the same texture points

  bool has_picture() const { return texture || emission_texture; }

  friend bool operator==(const Material&, const Material&) = default;
};

// NFF "l": without attenuation. A sun is infinitely far away: its rays are parallel.
struct Light {
  Vec3d position{0, 0, 0};        // of a sun: the direction to it, of any length
  std::optional<Rgb> color = {};  // absent: white, and written back without a colour
  SourceLocation location = {};
  bool is_sun = false;
};

// A background that changes evenly with the sine of the elevation above the horizon.
struct Sky {
  Vec3d up{0, 1, 0};  // to the zenith, of any length but 0
  Rgb horizon{1, 1, 1}, zenith{1, 1, 1};

  friend bool operator==(const Sky&, const Sky&) = default;
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

// Lists that the triangles of a mesh share. Front faces run counter-clockwise.
struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;  // empty: flat; as given, of any length
  // Empty: no texture. (0, 0) is the picture's upper left corner, (1, 1) the lower right.
  std::vector<Vec2d> texture_points;
  MaterialIndex material = 0;
  SourceLocation location = {};
};

// Indices into a mesh's lists, where it has them.
struct TriangleCorners {
  std::array<std::uint32_t, 3> position{}, normal{}, texture_point{};
};

struct Triangle {
  std::uint32_t mesh = 0;  // into SceneDescription::meshes
  TriangleCorners corners = {};
};

// AFF "tpa": a triangle whose corners move. Between keys positions and normals change evenly.
struct MovingTriangle {
  struct Key {
    double time = 0;
    std::array<Vec3d, 3> positions, normals;
  };
  std::vector<Key> keys;  // ascending, at least one
  MaterialIndex material = 0;
  SourceLocation location = {};
};

enum class PrimitiveKind : std::uint8_t { kSphere, kCone, kPolygon, kPatch, kTriangle, kMovingTriangle };

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
  std::vector<TriangleMesh> meshes;
  std::vector<Triangle> triangles;
  std::vector<MovingTriangle> moving_triangles;
  std::vector<PrimitiveRef> order;  // every primitive once, in file order

  // What NFF does not have.
  std::optional<Rgb> ambient;  // the ambient light; lights then count as written, not by NFF's rules
  std::optional<Sky> sky;      // in place of the background above the horizon
  std::vector<Texture> textures;
  Movement movement;
  std::vector<NodeIndex> nodes;        // in whose space each of `order` stands; empty: all in the world's
  std::vector<LightNode> light_nodes;  // of each light; empty: all rest in the world

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
void add_mesh(SceneDescription& scene, TriangleMesh mesh, std::span<const TriangleCorners> triangles);
void add_moving_triangle(SceneDescription& scene, MovingTriangle triangle);

// Returns the background; under a sky, below its horizon. Without one of its own it goes on as the horizon.
inline Rgb ground_color(const SceneDescription& scene) {
  return scene.background.value_or(scene.sky ? scene.sky->horizon : Rgb(0, 0, 0));
}

// Returns a light's position, or the direction to a sun, in the space that a map leads to. A map that leaves
// no direction, or one without end, does not turn a sun.
Vec3d place_of(const Light& light, const Affine& map);

// Returns the material of a primitive; `ref` must be in range.
MaterialIndex material_of(const SceneDescription& scene, PrimitiveRef ref);

// Returns the corners of a triangle of a mesh; normals are zero where the mesh has none.
std::array<PatchVertex, 3> corners_of(const SceneDescription& scene, const Triangle& triangle);

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

// Returns the view at a time: the track "camera" moves it. Empty where the scene has no view.
std::optional<View> view_at(const SceneDescription& scene, double time);

// Returns the triangle at a time; normals are of unit length where they are not zero.
MovingTriangle::Key shape_at(const MovingTriangle& triangle, double time);

// Returns the node in whose space a primitive stands; `place` is its place in the order.
inline NodeIndex node_of(const SceneDescription& scene, std::size_t place) {
  return scene.nodes.empty() ? 0 : scene.nodes[place];
}

// Returns the axis-parallel bounding box of a primitive in its node's space, exact for cones and spheres too;
// of a moving triangle that of all times. `ref` must be in range.
Box3d bounds(const SceneDescription& scene, PrimitiveRef ref);

// Returns the bounding box of all primitives, each in its node's space; empty when there are none.
Box3d bounds(const SceneDescription& scene);

}  // namespace pprt
