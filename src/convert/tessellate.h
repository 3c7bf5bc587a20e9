// Spheres and cones as triangles with interpolated normals, cut as Haines' Standard Procedural Databases cut
// them.
#pragma once

#include <optional>
#include <vector>

#include "scene/scene_description.h"
#include "scene/triangulate.h"

namespace pprt {

// How finely curved surfaces are cut.
struct Fineness {
  // N: a sphere becomes the 6 faces of a cube with N x N x 2 triangles each, a cone a ring of 4N x 2; at
  // least 1.
  int divisions = 6;
  // When given, each object gets its own N: the least for which no triangle lies farther inside the surface
  // than this, in the scene's units; positive. At most kMaxDivisions.
  std::optional<double> chord_error;
};

inline constexpr int kMaxDivisions = 1000;

// The N for an object. A degenerate one has none: 0.
int divisions(const Sphere& sphere, const Fineness& fineness);
int divisions(const Cone& cone, const Fineness& fineness);

// Triangles over shared vertices, counter-clockwise seen from where the surface is seen; unit normals.
struct Surface {
  std::vector<PatchVertex> vertices;
  std::vector<TriangleIndices> triangles;
};

// `n` at least 1; the vertices lie on the surface. A cone's tip takes no triangles of no area.
Surface tessellate(const Sphere& sphere, int n);
Surface tessellate(const Cone& cone, int n);

// Larger results are refused before anything is made.
inline constexpr std::size_t kMaxTriangles = 20'000'000;

// How many triangles the spheres and cones of the scene become.
std::size_t triangle_count(const SceneDescription& scene, const Fineness& fineness);

// Throws InputError when that is more than kMaxTriangles.
void check_triangle_count(const SceneDescription& scene, const Fineness& fineness);

// The scene with every sphere and cone as patches of three vertices; all else as it is. Throws InputError as
// check_triangle_count.
SceneDescription tessellated(const SceneDescription& scene, const Fineness& fineness);

}  // namespace pprt
