// From scattered samples to pixels: piecewise-linear over the triangulation (paper s. 2.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "pipeline/sample_mesh.h"

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

// Storage that lives from frame to frame.
struct ReconstructionBuffers {
  std::vector<Color> sums;  // of the samples in each pixel of the bounds
  std::vector<std::uint32_t> counts;
};

// What becomes of a pixel with more than one sample; interpolated only where a study asks what the mean is
// worth.
enum class CrowdedPixels : std::uint8_t { kMean, kInterpolated };

// Every pixel of `bounds`, as the mesh has it: the barycentric mean of the triangle that holds its centre or,
// when more than one sample falls in the pixel, their average. Each centre belongs to exactly one triangle,
// also on shared edges.
void reconstruct(const SampleMesh& mesh, const PixelRect& bounds, RegionPixels& pixels,
                 ReconstructionBuffers& buffers, CrowdedPixels crowded = CrowdedPixels::kMean);

// Per pixel of `bounds`, row by row: which of triangles(mesh) holds its centre, by the same rule;
// kNoTriangle where none does.
inline constexpr std::uint32_t kNoTriangle = ~std::uint32_t{0};
std::vector<std::uint32_t> triangle_at_centers(const SampleMesh& mesh, const PixelRect& bounds);

}  // namespace pprt
