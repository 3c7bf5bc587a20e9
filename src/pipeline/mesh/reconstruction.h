// Reconstruction: from scattered samples to pixels, piecewise linear over the triangulation (paper s. 2.2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/vector.h"
#include "pipeline/core/pixel_block.h"
#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/silhouettes/projected_shape_cache.h"

namespace pprt {

// An accumulated pixel: one that holds several samples or an edge. The last lanes pad; under kMean the last
// of the differences counts samples.
struct alignas(16) PixelSum {
  float base[4];         // the first sample's colour
  float differences[4];  // from it, summed over samples or area
};

// How a triangle of the mesh shows edges of primitives. kSmall: accumulated in every pixel that it touches.
// kLarge: at a few points of the pixels whose centres it holds, and over the area of accumulated pixels.
enum class TriangleEdge : std::uint8_t { kNone, kSmall, kLarge };

// Accumulated pixels by number, without a value at first: pages that no sum is written to take no memory.
class PixelSums {
 public:
  // Keeps the values unless there are more pixels than ever before.
  void resize(std::size_t pixels) {
    if (pixels <= size_) return;
    sums_ = std::make_unique_for_overwrite<PixelSum[]>(pixels);
    size_ = pixels;
  }
  PixelSum& operator[](std::size_t pixel) { return sums_[pixel]; }

 private:
  std::unique_ptr<PixelSum[]> sums_;
  std::size_t size_ = 0;
};

// Storage that lives from frame to frame. Pixels are numbered row by row within the bounds. `sums` has a
// meaning for pixels that hold a sample, its differences for accumulated pixels.
struct ReconstructionBuffers {
  std::vector<std::uint64_t> holds_one, holds_several;  // a bit per pixel, each row begins a new word
  std::vector<std::uint32_t> pixels;                    // those accumulated, in the order of their beginning
  PixelSums sums;
  std::vector<TriangleEdge> edges;  // per triangle of the mesh
};

// Computes every pixel of `bounds`: the barycentric interpolation in the triangle that holds its centre, or
// what the rule says. Each centre belongs to exactly one triangle, also on shared edges. `viewed` serves
// kEdges alone; it must be of the same eye as the samples. Without it no edges are shown.
void reconstruct(const SampleMesh& mesh, const PixelRect& bounds, PixelBlock& pixels,
                 ReconstructionBuffers& buffers, PixelRule rule = PixelRule::kArea,
                 ProjectedShapeCache* viewed = nullptr);

// Returns per pixel of `bounds`, row by row, the index in triangles(mesh) of the triangle that holds its
// centre, by the same rule; kNoTriangle where none does.
inline constexpr std::uint32_t kNoTriangle = ~std::uint32_t{0};
std::vector<std::uint32_t> triangle_at_centers(const SampleMesh& mesh, const PixelRect& bounds);

}  // namespace pprt
