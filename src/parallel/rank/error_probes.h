// Measures how wrong the shown pixels of a region are, by eye rays that the picture knows nothing of
// (docs/decisions/0034-measured-error.md).
//
// Let p be a pixel as shown, m the true mean over its area, and r1 and r2 two independent estimates of m
// without bias. Then (p - r1)(p - r2) has the expected value (p - m)^2, whatever the picture has missed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "parallel/protocol/error_sums.h"
#include "pipeline/core/pixel_block.h"
#include "pipeline/core/region.h"

namespace pprt {

// How many probes a measurement has, and how many eye rays each.
struct ProbePlan {
  std::uint64_t probes = 2;  // at least two, for an interval
  int side = 2;              // a probe estimates its pixel twice, each time by a jittered grid of side x side

  std::uint64_t samples() const { return 2 * static_cast<std::uint64_t>(side * side) * probes; }
};

// Plans for a frame in which a rank has traced `traced` samples: one eye ray in a hundred measures. A pixel's
// estimates take about as many eye rays as its picture, which has `samples` in `pixels`: 4 to 16.
ProbePlan plan_probes(std::uint64_t traced, std::uint64_t samples, std::size_t pixels);

// The address of a measurement's random numbers.
struct ProbeStream {
  std::uint64_t seed = 0;
  std::uint64_t frame = 0;
  std::uint64_t rank = 0;
};

// Measures the pixels of `region` in `shown` at some of them. `look` returns the colour at an image point.
// Returns all but `rays`.
ErrorSums measure_error(const Region& region, const PixelBlock& shown, const ProbePlan& plan,
                        const ProbeStream& stream, const std::function<Color(double x, double y)>& look);

}  // namespace pprt
