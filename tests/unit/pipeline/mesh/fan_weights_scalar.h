// The scalar twin of FanWeights: one triangle at a time, in the same order of operations, so both are equal
// to the bit. It stands here to be read beside the vector routine; only the test that compares them calls it.
#pragma once

#include <cstdint>

#include "pipeline/mesh/learned_weights.h"
#include "pipeline/mesh/mesh_corner.h"
#include "pipeline/mesh/refinement_weight.h"

namespace pprt::scalar {

struct FanWeight {
  float weight;
  Bin bin;
};

inline float squared_distance(const Color& a, const Color& b) {
  const auto square = [](float p, float q) {
    const float difference = held_to_unit(p) - held_to_unit(q);
    return difference * difference;
  };
  return square(a.x, b.x) + square(a.y, b.y) + square(a.z, b.z);
}

// Scalar twin of FanWeights::compute(): for the triangle of a boundary corner, the next one, and the apex.
inline FanWeight fan_weight(const MeshCorner& corner, const MeshCorner& next, const MeshCorner& apex,
                            float size_squared, const WeightTerms& terms) {
  const float variance =
      (squared_distance(corner.color, apex.color) + squared_distance(next.color, apex.color) +
       squared_distance(corner.color, next.color)) *
      (1.0F / 27);
  const auto whole = [](std::uint32_t primitive) { return static_cast<std::int32_t>(primitive); };
  const std::int32_t bin = bin_of(whole(apex.primitive), whole(corner.primitive), whole(next.primitive),
                                  variance, corner.feature + next.feature + apex.feature);
  return {refinement_weight(size_squared, variance, terms), static_cast<Bin>(bin)};
}

}  // namespace pprt::scalar
