// Polygons and patches as one indexed triangle mesh of the compiled space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"
#include "scene/triangulate.h"
#include "trace/embree.h"
#include "trace/quadrics.h"
#include "trace/user_geometry.h"

namespace pprt {

// What a ray needs to know to leave a triangle.
struct Facet {
  Vec3f normal{0, 0, 1};  // unit; the side from which the winding is counter-clockwise
  float offset = 0;       // see triangle_offset; the largest of the facet's whole polygon
};
static_assert(sizeof(Facet) == 16);

struct Mesh {
  std::vector<Vec3f> vertices;
  std::vector<Vec3f> normals;  // per vertex, unit, or zero where none was given; empty: no smooth shading
  std::vector<TriangleIndices> triangles;
  std::vector<Facet> facets;  // per triangle

  // Adds the triangles of a polygon in the compiled space, with a normal per vertex or none at all. Returns
  // how many: those that have no area in float are left out.
  std::size_t add(std::span<const Vec3d> polygon, std::span<const Vec3f> vertex_normals);
};

// The point of a triangle at barycentric coordinates u, v as Embree gives them.
SurfacePoint on_surface(const Mesh& mesh, std::uint32_t triangle, double u, double v);

// The interpolated normal, unit; the facet's where interpolation gives none. The mesh has normals.
Vec3d shading_normal(const Mesh& mesh, std::uint32_t triangle, double u, double v);

// A geometry that reads the mesh's buffers on every ray; `sides` as a filter on its hits. Appends the padding
// that Embree reads past the last vertex.
EmbreeGeometry new_mesh_geometry(const EmbreeDevice& device, Mesh& mesh, Sides sides);

}  // namespace pprt
