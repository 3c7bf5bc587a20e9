// A sampler whose samples each reach a known distance.
#pragma once

#include <span>

#include "pipeline/sampling/sampler.h"

namespace pprt {

// What a sample tells of the picture lies within its reach. So one exchange serves all samplers of this kind
// (parallel/exchange/point_exchange.h).
class PointSampler : public Sampler {
 public:
  // Changes which points are wanted; keeps all samples.
  virtual void set_region(const Region& region) = 0;

  // Returns how far a sample reaches from its point along each axis, pixels.
  virtual double reach(const Sample& sample) const = 0;

  // Takes the lights that these cast samples know, in place of those before.
  virtual void take_lights(std::span<const Sample> /*samples*/) {}
};

}  // namespace pprt
