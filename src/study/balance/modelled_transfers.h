// Local balancing during a frame that was recorded under another policy.
#pragma once

#include "parallel/balance/local_balance.h"
#include "parallel/balance/partition.h"
#include "render/trace/balance_trace.h"

namespace pprt {

// Moves tiles as neighbours would during the frame: `partition` is that of its beginning, and then of its
// end. Ranks decide at five moments of the first half of the frame, by the functions that they decide by in a
// run. What they know is modelled. A rank's mean weight falls as the reciprocal of the time. Every rank knows
// its neighbours' progress. No sample of a tile is known to its taker.
void move_tiles_locally(const TraceHeader& header, const TracedFrame& frame, BalanceMode policy,
                        const LocalBalanceSettings& settings, Partition& partition);

}  // namespace pprt
