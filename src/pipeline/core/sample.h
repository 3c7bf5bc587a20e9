// A sample: what one eye ray found at one image point.
#pragma once

#include <cstdint>

#include "base/ray_sample.h"

namespace pprt {

// Unique over all ranks during one triangulation: the rank that traced the sample in the upper bits, its
// running number in the lower 40.
using SampleId = std::uint64_t;

struct Sample {
  double x = 0;  // image point, pixels
  double y = 0;
  RaySample ray;
  SampleId id = 0;
  std::int32_t frame = 0;  // in which it was traced: its time stamp (paper s. 4.2)
};

}  // namespace pprt
