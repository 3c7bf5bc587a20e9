// What a run tells a sampler when it makes it.
#pragma once

#include <cstdint>

#include "base/probe.h"
#include "pipeline/core/region.h"

namespace pprt {

struct SamplerSetup {
  Region region;
  std::uint64_t seed = 1;
  std::uint64_t samples = 0;  // asked for in the whole image; 0: there is no such goal
  bool keeps_samples = true;  // somebody asks for samples()
  const Probe& probe;
};

}  // namespace pprt
