// Local balancing: tiles move between neighbours during a frame (paper s. 3.6, 4.3).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "parallel/balance/partition.h"
#include "parallel/protocol/tile_cost.h"
#include "pipeline/core/region_quality.h"

namespace pprt {

// Found by measurement (docs/decisions/0009-balancing.md).
struct LocalBalanceSettings {
  double giving_ratio = 1.0;    // a rank gives once its future cost is this multiple of its neighbours',
  double giving_noise = 3.5;    // and this much of its relative noise more,
  double weight_ratio = 1.0;    // to those whose mean weight is lower by this factor
  double cost_ratio = 1.0;      // and whose future cost is lower by this one
  double cost_noise = 14;       // and by this much of the noise
  double share = 0.3;           // of the difference in future cost that moves at once
  double balance_weight = 0.5;  // w1, of what a tile takes away, by the most that any takes away
  double communication_weight = 0.1;  // w2, of the share of its samples that the taker knows
  double border_weight = 0.15;        // w3, of the change of the border's length
  double shape_weight = 0.25;         // of the change of the regions' shapes
};

// How uncertain a region's future cost is, as a share of it: the reciprocal root of the triangles that it
// will have at the frame's end. Answering smaller differences would move tiles to and fro. `elapsed`: share
// of the sampling time that has passed.
double relative_noise(const RegionQuality& refined, double elapsed);
double relative_noise(std::int64_t triangles, double elapsed);

// Returns how much more a rank has to pay than its neighbours for what they aim at. It is the geometric mean
// of the ratios; 1 where no neighbour has reported. `own_future_cost`: at a target weight, by its pace.
double load_by_neighbours(std::span<const RankProgress> neighbours,
                          const std::function<double(double target)>& own_future_cost);

// Whether a rank with this load should give tiles. One that gives already goes on longer.
bool should_begin_to_give(const LocalBalanceSettings& settings, double load, double noise, bool is_giving);

// Whether a rank should give tiles to the neighbour that sent `theirs`. `own_future_cost`: by its pace, at
// theirs.target_weight. `noise`: relative_noise() of its region.
bool should_give(const LocalBalanceSettings& settings, double own_weight, double own_future_cost,
                 double noise, const RankProgress& theirs);

// The target that a rank at `mean_weight` > 0 names: the power of two at or below it, so that estimates are
// comparable.
double target_weight_for(double mean_weight);

// What the giver knows of one of its tiles.
struct TileOffer {
  double future_cost = 0;     // Fcost(s, Q') by the mean of both ranks' paces: what one saves and one pays
  double samples = 0;         // N_s
  double known_to_taker = 0;  // U(j, s)

  double unknown_to_taker() const { return samples - known_to_taker; }
};

// What bounds one transfer.
struct TransferBounds {
  double difference = 0;      // Delta: by how much the giver's future cost exceeds the taker's, in time
  double insertion_cost = 0;  // Icost: of one sample at the taker, in time
  double most_samples = 0;    // that the taker need take in
};

// Returns the giver's tiles along its border with the taker to transfer, best grade first, until the share of
// the difference that moves at once is reached. At most a quarter of the giver's tiles; its region stays
// connected and keeps at least one tile. `offer` is asked for tiles of the giver only.
std::vector<int> tiles_to_give(const LocalBalanceSettings& settings, const Partition& partition, int giver,
                               int taker, const TransferBounds& bounds,
                               const std::function<TileOffer(int tile)>& offer);

}  // namespace pprt
