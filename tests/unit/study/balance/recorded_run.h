// Runs of virtual ranks whose balancing is traced.
#pragma once

#include "render/trace/balance_trace.h"

namespace pprt {

// Under the work clock, with a picture whose right side is costly, so that equal areas are unequal loads.
SessionSettings uneven_settings(SamplerChoice sampler, BalanceMode balance);

// Returns the trace as it is read from its text.
BalanceTrace recorded_run(const SessionSettings& settings, int ranks = 5, int frames = 8);

}  // namespace pprt
