#include "parallel/local_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace pprt {
namespace {

// A tile's side neighbours, those that exist.
std::vector<int> beside(const TileGrid& grid, int tile) {
  const int column = tile % grid.columns(), row = tile / grid.columns();
  std::vector<int> tiles;
  if (column > 0) tiles.push_back(tile - 1);
  if (column + 1 < grid.columns()) tiles.push_back(tile + 1);
  if (row > 0) tiles.push_back(tile - grid.columns());
  if (row + 1 < grid.rows()) tiles.push_back(tile + grid.columns());
  return tiles;
}

struct Sides {
  int giver = 0, taker = 0;
};

Sides owners_beside(const Partition& partition, int tile, int giver, int taker) {
  Sides sides;
  for (const int t : beside(partition.grid, tile)) {
    const std::int32_t owner = partition.owner[static_cast<std::size_t>(t)];
    sides.giver += owner == giver;
    sides.taker += owner == taker;
  }
  return sides;
}

// Whether the giver stays in one piece without the tile.
bool can_spare(Partition& partition, int tile, int giver, int taker) {
  std::int32_t& owner = partition.owner[static_cast<std::size_t>(tile)];
  owner = taker;
  const bool whole = is_connected(partition, giver);
  owner = giver;
  return whole;
}

}  // namespace

bool should_give(const LocalBalanceSettings& settings, double own_quality, double own_future_cost,
                 const RankProgress& theirs) {
  return theirs.quality > 0 && own_quality > settings.quality_ratio * theirs.quality &&
         own_future_cost > settings.cost_ratio * theirs.future_cost;
}

double target_quality(double quality) {
  return std::exp2(std::floor(std::log2(quality)) - 1);
}

std::vector<int> tiles_to_give(const LocalBalanceSettings& settings, const Partition& before, int giver,
                               int taker, double difference, double insertion_cost, double most_samples,
                               const std::function<TileOffer(int tile)>& offer) {
  Partition partition = before;
  std::vector<int> given;
  auto owned = std::count(partition.owner.begin(), partition.owner.end(), giver);
  double to_move = 0.5 * difference;
  while (to_move > 0 && owned > 1) {
    double best_grade = 0;
    std::optional<int> best;
    double best_cost = 0, best_unknown = 0;
    for (int tile = 0; tile < partition.grid.tile_count(); ++tile) {
      if (partition.owner[static_cast<std::size_t>(tile)] != giver) continue;
      const Sides sides = owners_beside(partition, tile, giver, taker);
      if (sides.taker == 0) continue;
      const TileOffer o = offer(tile);
      // More than what is left to move would only turn the imbalance round.
      const double unknown = o.samples - o.known_to_taker;
      if (o.future_cost <= 0 || o.future_cost > 1.5 * to_move || unknown > most_samples) continue;
      const double balance = (o.future_cost - insertion_cost * unknown) / difference;
      const double known = o.samples > 0 ? o.known_to_taker / o.samples : 1;
      const double longer_border = 0.25 * (sides.giver - sides.taker);
      const double grade = settings.balance_weight * balance +
                           (settings.communication_weight * known - settings.border_weight * longer_border) *
                               std::min(1.0, o.future_cost / to_move);
      if ((best && grade <= best_grade) || balance <= 0 || !can_spare(partition, tile, giver, taker))
        continue;
      best = tile, best_grade = grade, best_cost = o.future_cost, best_unknown = unknown;
    }
    if (!best) break;
    partition.owner[static_cast<std::size_t>(*best)] = taker;
    given.push_back(*best);
    to_move -= best_cost;
    most_samples -= best_unknown;
    --owned;
  }
  return given;
}

}  // namespace pprt
