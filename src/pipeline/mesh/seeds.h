// Seeds: the coarse set of points that every new triangulation starts from.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "pipeline/mesh/sample_mesh.h"

namespace pprt {

// Pixels between seeds. Found by measurement (docs/decisions/0008-seeds.md): coarse enough to cost little,
// dense enough that small features are met and every rank's region holds several.
inline constexpr double kSeedSpacing = 16;

// About the most seeds of a picture: those of 4096x4096 pixels. What shows in a larger picture is as much
// larger, and a picture of few samples is not to wait for more seeds than these.
inline constexpr double kMostSeeds = 0x1p16;

// Returns a jittered grid over the image, in pixels, with points exactly on its borders and corners. The
// first four are the image's corners. It depends on size and seed alone: it is the same for every rank and
// frame.
std::vector<Vec2d> seed_points(int width, int height, std::uint64_t seed);

// Those points with their Delaunay triangles. Corners index `points`.
struct SeedPattern {
  std::vector<Vec2d> points;
  std::vector<MeshTriangle> triangles;
};
SeedPattern seed_pattern(int width, int height, std::uint64_t seed);

}  // namespace pprt
