// Balancing replayed from a trace: which tiles each rank would own under a policy.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/session_settings.h"
#include "render/balance_trace.h"

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
// recorded ones again. Another policy has figures that it would have had if the cost of a tile times its mean
// weight did not depend on its owner (modelled_transfers.h, figures_under()).
//
// `local`: of decisions made during frames.
std::vector<ReplayedRound> replay(const BalanceTrace& run, BalanceMode policy,
                                  const LocalBalanceSettings& local = {});

// Per rank: the time, in work units at pace 1, until its tiles have the mean weight of the whole image (paper
// s. 4.4), without ranks that are lost.
std::vector<double> loads(const TraceHeader& header, const TracedFrame& frame,
                          const std::vector<std::int32_t>& owners);

}  // namespace pprt
