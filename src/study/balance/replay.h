// Balancing replayed from a trace: which tiles each rank would own under a policy.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/session_settings.h"
#include "render/trace/balance_trace.h"

namespace pprt {

// One frame of a replay.
struct ReplayedRound {
  int frame = 1;                     // its number
  std::vector<std::int32_t> owners;  // per tile, at the frame's end
  bool repartitioned = false;
  int moved = 0;         // tiles that had another owner at the end of the frame before
  double deviation = 0;  // standard deviation of the ranks' loads by their mean
  double worst = 0;      // largest load by the mean
  int differing = 0;     // tiles that the trace says another rank owned
};

// Replays a run. The policy that ran is replayed from the inputs that its decisions had, so it makes the
// recorded ones again. Another policy has modelled ones: the cost of a tile times its mean weight does not
// depend on its owner (figures_under(), modelled_transfers.h).
//
// `local`: of decisions made during frames.
std::vector<ReplayedRound> replay(const BalanceTrace& run, BalanceMode policy,
                                  const LocalBalanceSettings& local = {});

// Returns the load of each rank that is not lost (paper s. 4.4): the time until its tiles have the mean
// weight of the whole image. In work units at pace 1.
std::vector<double> loads(const TraceHeader& header, const TracedFrame& frame,
                          const std::vector<std::int32_t>& owners);

}  // namespace pprt
