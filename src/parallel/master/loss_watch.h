// Ranks that do not answer any more, because a host was cut off or a process has died.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "parallel/master/rank_clocks.h"

namespace pprt {

// What becomes of a run then. Only on the wall clock: on the work clock ranks wait for each other.
struct LossRule {
  double patience_s = 8;  // without an answer
  // With a rate only: the others take over the tiles of a rank that does not answer. Otherwise the run ends
  // once no rank of a host answers; a single rank may be slow.
  bool goes_on = false;
  std::function<std::string(int rank)> host_of = [](int) { return std::string(); };
  std::function<void(std::span<const int> ranks)> told = [](std::span<const int>) {};  // of the loss
};

// "rank 2 on alpha, ranks 5 to 7 on beta". `ranks`: ascending.
std::string name_ranks(std::span<const int> ranks, const std::function<std::string(int rank)>& host_of);

class LossWatch {
 public:
  // `clocks` must outlive it.
  LossWatch(const LossRule& rule, const RankClocks& clocks, int ranks);

  // Returns the ranks that are lost since the last call, ascending. `is_awaited`: whether a frame waits for
  // the rank; one that has done its work may be silent. Throws std::runtime_error with the ranks' names when
  // the run must end.
  std::vector<int> newly_lost(const std::function<bool(int rank)>& is_awaited);

 private:
  bool is_host_silent(const std::string& host) const;

  LossRule rule_;
  const RankClocks& clocks_;
  std::vector<bool> lost_;  // per rank
  double next_s_ = 0;       // when to look again, by the clocks' waking time
};

}  // namespace pprt
