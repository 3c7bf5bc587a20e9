// What a tile has cost and will cost (paper s. 3.6, 4.3, 4.4).
#pragma once

#include <algorithm>
#include <cstdint>

namespace pprt {

// A tile's samples: their cost in work units, and the mean weight of its triangles that they have led to.
struct TileEstimate {
  double cost = 0;
  double average_weight = 0;
};

// Fcost(i, Q) = LastCost(i) LastAvgWeight(i) / Q - Cost(i), with `paid` = Cost(i): the mean weight falls as
// the reciprocal of the samples. 0 where the quality is reached. `quality` > 0.
inline double future_cost(const TileEstimate& last, double paid, double quality) {
  return std::max(0.0, last.cost * last.average_weight / quality - paid);
}

// Rank to neighbours, every few samples: how far it is, and what it still has to pay for a common goal.
struct RankProgress {
  double quality = 0;      // Q_k; 0: nothing is known yet
  double target = 0;       // Q'
  double future_cost = 0;  // Fcost_k(Q'), work units
};

// A tile changes hands, with all that the new owner needs to estimate its cost.
struct TileTransfer {
  std::int32_t tile = 0;
  std::int32_t owner = 0;     // from now on
  std::uint64_t version = 0;  // of this ownership; see Partition
  TileEstimate now;           // in this frame
  TileEstimate last;          // at the end of the frame before
};

// Rank to master, with its pixels (paper s. 4.4).
struct TileReport {
  std::int32_t tile = 0;
  std::int32_t triangles = 0;  // LastTotalNum
  double total_weight = 0;     // LastTotalWeight
  double cost = 0;             // LastCost, work units
  double reconstruction = 0;   // Restore
  double preparation = 0;      // Pre, with its share of what other ranks' samples cost its owner
};

}  // namespace pprt
