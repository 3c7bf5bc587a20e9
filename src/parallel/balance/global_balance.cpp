#include "parallel/balance/global_balance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pprt {

double imbalance(std::span<const std::vector<TileReport>> of_rank) {
  double sum = 0, squares = 0;
  int ranks = 0;
  for (const std::vector<TileReport>& tiles : of_rank) {
    double weight = 0, triangles = 0;
    for (const TileReport& t : tiles) weight += t.total_weight, triangles += t.triangles;
    if (triangles == 0) continue;
    const double mean = weight / triangles;
    sum += mean;
    squares += mean * mean;
    ++ranks;
  }
  if (ranks == 0 || sum <= 0) return 0;
  const double mean = sum / ranks;
  return std::sqrt(std::max(0.0, squares / ranks - mean * mean)) / mean;
}

std::vector<TileEstimate> tile_estimates(const TileGrid& grid,
                                         std::span<const std::vector<TileReport>> of_rank) {
  std::vector<TileEstimate> estimates(static_cast<std::size_t>(grid.tile_count()));
  for (const std::vector<TileReport>& tiles : of_rank) {
    for (const TileReport& t : tiles) {
      estimates[static_cast<std::size_t>(t.tile)] = {t.cost,
                                                     t.triangles > 0 ? t.total_weight / t.triangles : 0};
    }
  }
  return estimates;
}

std::vector<double> predicted_costs(const TileGrid& grid, std::span<const std::vector<TileReport>> of_rank) {
  double weight = 0, triangles = 0;
  for (const std::vector<TileReport>& tiles : of_rank) {
    for (const TileReport& t : tiles) weight += t.total_weight, triangles += t.triangles;
  }
  const double quality = triangles > 0 && weight > 0 ? weight / triangles : 1;
  std::vector<double> costs(static_cast<std::size_t>(grid.tile_count()), -1);
  double known = 0, sum = 0;
  for (const std::vector<TileReport>& tiles : of_rank) {
    for (const TileReport& t : tiles) {
      const double mean_weight = t.triangles > 0 ? t.total_weight / t.triangles : 0;
      // Fcost(i, A) + LastCost(i): what the tile takes in all.
      const double sampling = std::max(t.cost * mean_weight / quality, 0.0);
      double& cost = costs[static_cast<std::size_t>(t.tile)];
      cost = sampling + t.reconstruction + t.preparation;
      sum += cost;
      ++known;
    }
  }
  for (double& cost : costs) {
    if (cost < 0) cost = known > 0 ? sum / known : 1;
  }
  return costs;
}

}  // namespace pprt
