// Polygons and patches as one indexed triangle mesh of the compiled space.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "scene/polygons/triangulate.h"
#include "trace/geometry/embree.h"
#include "trace/geometry/quadrics.h"
#include "trace/geometry/user_geometry.h"

namespace pprt {

// What a ray needs to leave a triangle.
struct Facet {
  Vec3f normal{0, 0, 1};  // unit; on the side from which the winding is counter-clockwise
  float offset = 0;       // see triangle_offset; the largest of all triangles of the polygon
};
static_assert(sizeof(Facet) == 16);

// An indexed triangle mesh.
struct Mesh {
  std::vector<Vec3f> vertices;
  std::vector<Vec3f> normals;         // per vertex, unit, or zero where none was given; empty: flat shading
  std::vector<Vec2f> texture_points;  // per vertex; empty: no texture
  std::vector<TriangleIndices> triangles;
  std::vector<Facet> facets;  // one per triangle

  // Adds a polygon of the compiled space, with one normal per vertex or none. Returns the number of triangles
  // added; those without area in float are left out.
  std::size_t add(std::span<const Vec3d> polygon, std::span<const Vec3f> vertex_normals);

  // Gives a triangle with vertices of its own another shape, perhaps one without area.
  void set_shape(std::size_t triangle, const std::array<Vec3d, 3>& corners,
                 const std::array<Vec3f, 3>& corner_normals);
};

// A point of a triangle, and the weights of its second and third corner: >= 0, and u + v <= 1.
struct TrianglePoint : SurfacePoint {
  double u = 0, v = 0;
};

// Returns where a ray that Embree found to hit the triangle crosses its plane, moved onto the triangle if it
// passes beside it by Embree's rounding. In double and without approximate reciprocals, for these differ
// between makes of processors. Source: Moeller and Trumbore, Fast, minimum storage ray/triangle intersection,
// 1997.
TrianglePoint on_surface(const Mesh& mesh, std::uint32_t triangle, const Vec3d& origin,
                         const Vec3d& direction);

// Returns the interpolated unit normal, or the facet's where interpolation gives none. The mesh must have
// normals.
Vec3d shading_normal(const Mesh& mesh, std::uint32_t triangle, double u, double v);

// Returns the way from a point of a triangle with normals to the smooth surface that the normals describe,
// where that bulges to the side of `side`; else 0. Shadow rays start there: neighbouring facets would hide
// lights that the smooth surface sees. At most half the longest edge.
Vec3d rise_to_smooth(const Mesh& mesh, std::uint32_t triangle, const TrianglePoint& at, const Vec3d& side);

// Returns the texture coordinates. The mesh must have them.
Vec2d texture_point(const Mesh& mesh, std::uint32_t triangle, double u, double v);

// How the texture coordinates change along a triangle: their gradients, in its plane.
struct TextureGradients {
  Vec3d u{0, 0, 0}, v{0, 0, 0};
};

// The mesh must have texture coordinates.
TextureGradients texture_gradients(const Mesh& mesh, std::uint32_t triangle);

// Returns the mean curvature of the smooth surface that the normals describe, > 0 where it bulges to their
// side. The mesh must have normals.
double mean_curvature(const Mesh& mesh, std::uint32_t triangle);

// Makes a geometry that reads the mesh's buffers on every ray: the mesh must outlive it and not move. A
// filter drops hits on invisible faces. Appends the padding that Embree reads past the last vertex.
EmbreeGeometry new_mesh_geometry(const EmbreeDevice& device, Mesh& mesh, VisibleFaces faces);

}  // namespace pprt
