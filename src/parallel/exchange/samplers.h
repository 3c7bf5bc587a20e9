// The samplers that there are: what each states of itself, and how it is made. docs/extending.md shows how to
// add one.
#pragma once

#include <memory>

#include "base/probe.h"
#include "parallel/balance/partition.h"
#include "parallel/exchange/sample_exchange.h"
#include "parallel/settings/session_settings.h"
#include "pipeline/sampling/sampler.h"
#include "pipeline/sampling/sampler_traits.h"

namespace pprt {

const SamplerTraits& traits_of(SamplerChoice choice);

// A sampler with its exchange, which refers to it.
struct SamplerWithExchange {
  std::unique_ptr<Sampler> sampler;
  std::unique_ptr<SampleExchange> exchange;
};

// Makes the sampler that the settings choose, for the rank's region.
SamplerWithExchange make_sampler(const SessionSettings& settings, const Partition& partition, int rank,
                                 const Probe& probe);

}  // namespace pprt
