// The coarse set of points that every frame starts from.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

// Pixels between seeds. Found by measurement (docs/decisions/0008-seeds.md): coarse enough to cost little,
// dense enough that small features are met and every rank's region holds several.
inline constexpr double kSeedSpacing = 16;

// A jittered grid over the image, borders and corners included (points there keep to their border exactly).
// The first four are the image's corners. The same for every rank and frame: depends on size and seed alone.
std::vector<Vec2d> seed_points(int width, int height, std::uint64_t seed);

// Those points with their Delaunay triangles, whose corners index them.
struct SeedPattern {
  std::vector<Vec2d> points;
  std::vector<MeshTriangle> triangles;
};
SeedPattern seed_pattern(int width, int height, std::uint64_t seed);

}  // namespace pprt
