// From scattered samples to pixels: piecewise-linear over the triangulation (paper s. 2.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "pipeline/reconstruction/projected_shape_cache.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

// The pixels of a rectangle, row by row from the top.
struct RegionPixels {
  PixelRect bounds;
  std::vector<Color> colors;

  const Color& at(int x, int y) const {
    return colors[static_cast<std::size_t>(y - bounds.y0) * static_cast<std::size_t>(bounds.width()) +
                  static_cast<std::size_t>(x - bounds.x0)];
  }
};

// What a pixel that holds several samples shows. Others show the interpolation at their centre, but for
// kEdges.
enum class PixelRule : std::uint8_t {
  kCenter,  // the interpolation at its centre as well
  kMean,    // the samples' mean: the paper's rule
  kArea,    // the interpolation's mean over the pixel's area
  kEdges    // the same, and triangles with corners on different primitives show each where it is seen
};

// A pixel that holds several samples or an edge. The fourth lanes pad; that of the sum counts samples where
// their mean is shown.
struct alignas(16) PixelSum {
  float base[4];         // the first sample's colour
  float differences[4];  // from it, summed over samples or area
};

// Of a triangle of the mesh, whether edges of primitives are shown in it, and how: every pixel that a small
// one touches is shown by area; a large one shows them at a few points of the pixels whose centres it holds,
// and where pixels are shown by area anyhow, in these.
enum class TriangleEdge : std::uint8_t { kNone, kSmall, kLarge };

// Storage that lives from frame to frame. Pixels are numbered row by row within the bounds; `sums` has a
// meaning for those that hold a sample, the differences for those that hold several.
struct ReconstructionBuffers {
  std::vector<std::uint64_t> holds_one, holds_several;  // a bit a pixel, each row beginning a new word
  std::vector<std::uint32_t> pixels;                    // those that hold several, in the order of the second
  std::vector<PixelSum> sums;
  std::vector<TriangleEdge> edges;  // per triangle of the mesh
};

// Every pixel of `bounds`, as the mesh has it: the barycentric mean of the triangle that holds its centre,
// and what the rule says where there are samples. Each centre belongs to exactly one triangle, also on shared
// edges. `viewed`, of the same eye as the samples, is asked under kEdges alone.
void reconstruct(const SampleMesh& mesh, const PixelRect& bounds, RegionPixels& pixels,
                 ReconstructionBuffers& buffers, PixelRule rule = PixelRule::kArea,
                 ProjectedShapeCache* viewed = nullptr);

// Per pixel of `bounds`, row by row: which of triangles(mesh) holds its centre, by the same rule;
// kNoTriangle where none does.
inline constexpr std::uint32_t kNoTriangle = ~std::uint32_t{0};
std::vector<std::uint32_t> triangle_at_centers(const SampleMesh& mesh, const PixelRect& bounds);

}  // namespace pprt
