// A sample: one eye ray's answer at one image point.
#pragma once

#include <cstdint>

#include "base/ray_sample.h"

namespace pprt {

// Unique over all ranks while one triangulation lives: the creator's rank above, its running number below.
using SampleId = std::uint64_t;

struct Sample {
  double x = 0;  // image point, pixels
  double y = 0;
  RaySample ray;
  SampleId id = 0;
  std::int32_t frame = 0;  // in which it was traced: its time stamp (paper s. 4.2)
};

}  // namespace pprt
