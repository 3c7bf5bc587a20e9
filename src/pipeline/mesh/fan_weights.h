// Weights and bins of the triangles around a new sample, four triangles at a time. Private to the pipeline.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/simd.h"
#include "pipeline/mesh/delaunay.h"
#include "pipeline/mesh/learned_weights.h"
#include "pipeline/mesh/mesh_corner.h"
#include "pipeline/mesh/refinement_weight.h"

namespace pprt {

// Keeps its storage from one insertion to the next.
class FanWeights {
 public:
  // Computes the weight and the bin of every triangle in mesh.new_triangles(). The apex of their fan is the
  // last of the corners. Entries of triangles that are not finite have no meaning.
  // Scalar twin: fan_weight() in fan_weights_scalar.h.
  void compute(const Delaunay& mesh, const std::vector<MeshCorner>& corners, const WeightTerms& terms);

  float weight(std::size_t k) const { return weights_[k]; }
  Bin bin(std::size_t k) const { return bins_[k]; }

 private:
  void gather(std::span<const Delaunay::Index> boundary, const std::vector<MeshCorner>& corners);

  // Per corner of the fan's boundary. The first entry is repeated after the last one.
  std::vector<float4> shown_;  // colour on the display scale
  std::vector<std::int32_t> primitives_, features_;
  // Per new triangle.
  std::vector<float> weights_;
  std::vector<Bin> bins_;
};

}  // namespace pprt
