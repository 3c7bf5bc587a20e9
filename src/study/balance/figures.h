// What ranks would have reported of a recorded frame if they had owned other tiles.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/balance/tile_cost.h"
#include "render/trace/balance_trace.h"

namespace pprt {

// Work of one rank in a frame. It sampled for as long with other tiles, but to another mean weight.
struct RankWork {
  double spent = 0;   // on sampling and preparation: work units
  double needed = 0;  // for sampling its tiles to a mean weight of 1: work units
  double preparation = 0;
  double triangles = 0;
  bool as_recorded = true;  // it owns the tiles that it reported

  // Mean weight at the frame's end; 0 where it has nothing to refine.
  double quality() const;
};

// Cost of sampling a tile to a mean weight of 1, work units: what an owner spends does not change it.
double work_at_weight_1(const TileReport& tile);

// Per rank. `owners`: per tile.
std::vector<RankWork> work_under(const TracedFrame& frame, const std::vector<std::int32_t>& owners);

// Returns reports per rank, as GlobalBalancer takes them. Ranks whose tiles are those that they reported get
// their own reports. Tiles that nobody reported are left out.
std::vector<std::vector<TileReport>> figures_under(const TracedFrame& frame,
                                                   const std::vector<std::int32_t>& owners);

}  // namespace pprt
