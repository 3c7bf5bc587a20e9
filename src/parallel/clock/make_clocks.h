// The only place of a rank that asks which clock a run is on. It answers with objects that behave
// accordingly.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "parallel/clock/delivery_clock.h"
#include "parallel/clock/exchange_policy.h"
#include "parallel/clock/frame_clock.h"
#include "parallel/clock/host_time.h"
#include "parallel/clock/sequence_clock.h"
#include "parallel/settings/session_settings.h"

namespace pprt {

// Whether equal runs give equal frames whatever the machine: time is counted work, in a budget of units.
bool is_reproducible(const SessionSettings& settings);

// A rank's clock. `sequence` must outlive it. `region_pixels`: number of pixels that the rank reconstructs.
// `ranks_per_core`: number of ranks that share a core, at least 1. `refreshes_in_parts`: see SamplerTraits.
std::unique_ptr<FrameClock> make_frame_clock(const SessionSettings& settings, int rank,
                                             const SequenceClock& sequence, std::size_t region_pixels,
                                             double ranks_per_core, bool refreshes_in_parts);

// How a rank exchanges bundles with the others.
std::unique_ptr<ExchangePolicy> make_exchange_policy(const SessionSettings& settings, int ranks);

// The master's clock. `now` tells the time as monotonic_seconds() does.
std::unique_ptr<DeliveryClock> make_delivery_clock(const SessionSettings& settings, double ranks_per_core,
                                                   std::function<double()> now = monotonic_seconds);

}  // namespace pprt
