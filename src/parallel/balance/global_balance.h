// Global balancing: the master cuts the image anew from what every tile has cost (paper s. 4.4, 4.5).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "parallel/balance/partition.h"
#include "parallel/balance/tile_cost.h"

namespace pprt {

// In `combined` the image is cut anew when the ranks' mean weights deviate by more than this share of their
// mean. Found by measurement (docs/decisions/0009-balancing.md).
inline constexpr double kImbalanceTrigger = 0.2;

// Dev / AvgWeight of s. 4.5 over the ranks that have triangles: standard deviation by mean of the ranks' mean
// weights. `of_rank[k]` are rank k's tiles.
double imbalance(std::span<const std::vector<TileReport>> of_rank);

// What each tile of the grid took; zero for tiles nobody reported.
std::vector<TileEstimate> tile_estimates(const TileGrid& grid,
                                         std::span<const std::vector<TileReport>> of_rank);

// Cost(i) of s. 4.4 for every tile of the grid: what it takes to bring it to the mean weight A of the whole
// image, besides its reconstruction and preparation. Tiles nobody reported cost the mean of the others.
std::vector<double> predicted_costs(const TileGrid& grid, std::span<const std::vector<TileReport>> of_rank);

}  // namespace pprt
