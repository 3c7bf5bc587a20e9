// What refinement and reconstruction need of a sample, beside its point: 20 bytes instead of a whole Sample.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/simd.h"
#include "base/vector.h"
#include "pipeline/mesh/learned_weights.h"

namespace pprt {

struct MeshCorner {
  Color color{0, 0, 0};
  std::uint32_t primitive = 0;  // as in RaySample
  Feature feature = 0;
  bool own = false;  // in the region of the mesh

  // Red, green, blue and 0.
  float4 channels() const { return channels_before_more(this); }
};

static_assert(offsetof(MeshCorner, primitive) == sizeof(Color),
              "channels() reads four bytes after the colour");

}  // namespace pprt
