// The steps of casting, for the samplers that cast their own samples.
#pragma once

#include <cstdint>

#include "base/camera.h"
#include "pipeline/casting/casting.h"

namespace pprt {

enum class CastOutcome : std::uint8_t { kForeign, kOutOfView, kTooOld, kHidden, kCast };

// A sample as the next camera sees it.
struct ProjectedSample {
  Vec2d point{0, 0};    // in the next image, pixels
  double distance = 0;  // from the next eye; infinite for the background
  CastOutcome outcome = CastOutcome::kForeign;
  bool is_before_eye = false;  // else `point` has no meaning
};

// Projects a sample of the region; kForeign where it lies elsewhere.
ProjectedSample project_sample(const Sample& sample, const Region& region, const Camera& next, int next_frame,
                               const CastSettings& settings);

// Carries the sample to where its object is now. Returns whether it is of use there.
bool is_carried(Sample& sample, const CastSettings& settings);

// Adds a sample to the result: itself, or its count.
void collect(const Sample& sample, const ProjectedSample& projected, CastResult& result);

// Turns the sum of the samples' ways into their mean.
CastResult with_mean_way(CastResult result);

}  // namespace pprt
