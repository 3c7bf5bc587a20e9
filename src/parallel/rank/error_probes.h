// Measures how wrong the shown pixels of a region are, by eye rays that the picture knows nothing of
// (docs/decisions/0034-measured-error.md).
//
// Let p be a pixel as shown, m the true mean over its area, and r1 and r2 two independent estimates of m
// without bias. Then (p - r1)(p - r2) has the expected value (p - m)^2, whatever the picture has missed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/vector.h"
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

// Plans for a frame in which a rank has traced `traced` samples: a share of the eye rays measures. A pixel's
// estimates take about as many eye rays as its picture, which has `samples` in `pixels`: 4 to 16.
ProbePlan plan_probes(std::uint64_t traced, std::uint64_t samples, std::size_t pixels, double share = 0.01);

// What a rank's probes take: rays of all kinds for an eye ray. They are where ray trees are large, and
// nothing is carried for them.
class ProbePrice {
 public:
  // Takes note of what a frame's measurement took.
  void add(const ErrorSums& frame);

  // Returns the share of a frame's eye rays that measure, `share` at most: all rays for it are 1.25 `share`
  // of the picture's. `traced`: eye rays of the picture, which took `rays` of all kinds.
  double affordable_share(double share, std::uint64_t traced, std::uint64_t rays) const;

 private:
  double samples_ = 0, rays_ = 0;  // of the last frames
};

// The address of a measurement's random numbers.
struct ProbeStream {
  std::uint64_t seed = 0;
  std::uint64_t frame = 0;
  std::uint64_t rank = 0;
  std::uint64_t batch = 0;  // of a frame that is measured several times
};

// A pixel of a region with two independent estimates of its true colour.
struct PixelProbe {
  int x = 0, y = 0;
  double weight = 1;     // of its squared error in the mean over probes that estimates the region's sum
  bool is_even = false;  // the picture showed nothing around it when the probe was traced
  Color first, second;
};

// Returns the colour at an image point. Textures are filtered over a square of side `footprint`, pixels.
using Look = std::function<Color(double x, double y, double footprint)>;

// Traces probes at pixels of `region`, chosen by what is `shown` now. They measure any picture of the same
// scene.
std::vector<PixelProbe> trace_probes(const Region& region, const PixelBlock& shown, const ProbePlan& plan,
                                     const ProbeStream& stream, const Look& look);

// Returns what the probes tell of the pixels of `region` in `shown`: all but `samples` and `rays`.
ErrorSums error_by(std::span<const PixelProbe> probes, const Region& region, const PixelBlock& shown);

// Measures the pixels of `region` in `shown` by new probes. Returns all but `rays`.
ErrorSums measure_error(const Region& region, const PixelBlock& shown, const ProbePlan& plan,
                        const ProbeStream& stream, const Look& look);

}  // namespace pprt
