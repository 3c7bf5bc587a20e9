// Local balancing: tiles move between neighbours during a frame (paper s. 3.6, 4.3).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "parallel/balance/partition.h"
#include "parallel/balance/tile_cost.h"

namespace pprt {

// Found by measurement (docs/decisions/0009-balancing.md).
struct LocalBalanceSettings {
  double giving_ratio = 1.03;         // begin to give when the neighbours have so much less to pay
  double quality_ratio = 1.0;         // give to those whose quality is so much better, and
  double cost_ratio = 1.4;            // future cost so much lower,
  double share = 0.3;                 // at once, this share of the difference in future cost
  double balance_weight = 0.5;        // w1: what a tile takes away, by the most that any takes away
  double communication_weight = 0.1;  // w2: share of its samples that the taker knows
  double border_weight = 0.15;        // w3: change of the border's length, and
  double shape_weight = 0.25;         // of the regions' shapes
};

// Whether a rank should give tiles to the neighbour that sent `theirs`; `own_future_cost` is at
// theirs.target.
bool should_give(const LocalBalanceSettings& settings, double own_quality, double own_future_cost,
                 const RankProgress& theirs);

// A target quality that a rank at `quality` names: a power of two below it, so that estimates are comparable.
double target_quality(double quality);

// What the giver knows of one of its tiles.
struct TileOffer {
  double future_cost = 0;     // Fcost(s, Q'), work units
  double samples = 0;         // N_s
  double known_to_taker = 0;  // U(j, s)
};

// Which of the giver's tiles along its border with the taker to give, one after the other by their grade,
// until its share of `difference` (Delta, the ranks' difference in future cost) has moved. The giver's region
// stays connected and keeps at least one tile, and the taker need not take in more than `most_samples`.
// `offer` is asked for tiles of the giver only; `insertion_cost` is Icost, work units.
std::vector<int> tiles_to_give(const LocalBalanceSettings& settings, const Partition& partition, int giver,
                               int taker, double difference, double insertion_cost, double most_samples,
                               const std::function<TileOffer(int tile)>& offer);

}  // namespace pprt
