// Spheres and cones as triangles with interpolated normals, divided as in Haines' Standard Procedural
// Databases.
#pragma once

#include <optional>
#include <vector>

#include "scene/description/scene_description.h"
#include "scene/polygons/triangulate.h"

namespace pprt {

// How finely curved surfaces are divided.
struct Fineness {
  // N, at least 1. A sphere becomes the 6 faces of a cube with N x N x 2 triangles each, a cone a ring of
  // 4N x 2.
  int divisions = 6;
  // Chord error, positive, in the scene's units. When given, each object gets its own N: the least for which
  // no triangle lies farther inside the surface, but at most kMaxDivisions.
  std::optional<double> chord_error;
};

inline constexpr int kMaxDivisions = 1000;

// Returns N for an object; 0 for a degenerate one.
int divisions(const Sphere& sphere, const Fineness& fineness);
int divisions(const Cone& cone, const Fineness& fineness);

// Triangles over shared vertices, counter-clockwise as seen from the visible side; unit normals.
struct Surface {
  std::vector<PatchVertex> vertices;
  std::vector<TriangleIndices> triangles;
};

// Returns triangles with all vertices on the surface; `n` is at least 1. A cone's tip gets no triangles
// without area.
Surface tessellate(const Sphere& sphere, int n);
Surface tessellate(const Cone& cone, int n);

// Larger results are refused before they are computed.
inline constexpr std::size_t kMaxTriangles = 20'000'000;

// Returns the number of triangles that the spheres and cones of the scene become.
std::size_t triangle_count(const SceneDescription& scene, const Fineness& fineness);

// Throws InputError when that exceeds kMaxTriangles.
void check_triangle_count(const SceneDescription& scene, const Fineness& fineness);

// Returns the scene with every sphere and cone as patches of three vertices, and all else unchanged. The
// chord error holds at the animation's start. Throws InputError as check_triangle_count().
SceneDescription tessellated(const SceneDescription& scene, const Fineness& fineness);

// The same for those spheres and cones alone that a node stretches unevenly. Nothing may move (still_at()).
// Leaves no nodes.
SceneDescription with_stretched_tessellated(const SceneDescription& scene, const Fineness& fineness);

}  // namespace pprt
