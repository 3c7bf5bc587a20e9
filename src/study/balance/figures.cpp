#include "study/balance/figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pprt {

double RankWork::quality() const {
  // Preparation is estimated: it must leave some of the time.
  constexpr double kLeastShare = 0.05;
  const double sampling = std::max(spent - preparation, kLeastShare * spent);
  return sampling > 0 ? needed / sampling : 0;
}

double work_at_weight_1(const TileReport& tile) {
  return tile.triangles > 0 ? tile.cost * tile.total_weight / tile.triangles : 0;
}

std::vector<RankWork> work_under(const TracedFrame& frame, const std::vector<std::int32_t>& owners) {
  std::vector<RankWork> ranks(frame.ranks.size());
  for (std::size_t t = 0; t < frame.tiles.size(); ++t) {
    if (frame.owners[t] < 0) continue;
    const TileReport& tile = frame.tiles[t];
    RankWork& recorded = ranks[static_cast<std::size_t>(frame.owners[t])];
    RankWork& owner = ranks[static_cast<std::size_t>(owners[t])];
    recorded.spent += tile.cost + tile.preparation;
    owner.needed += work_at_weight_1(tile);
    owner.preparation += tile.preparation;
    owner.triangles += tile.triangles;
    if (&owner != &recorded) owner.as_recorded = recorded.as_recorded = false;
  }
  return ranks;
}

std::vector<std::vector<TileReport>> figures_under(const TracedFrame& frame,
                                                   const std::vector<std::int32_t>& owners) {
  const std::vector<RankWork> ranks = work_under(frame, owners);
  std::vector<std::vector<TileReport>> figures(ranks.size());
  for (std::size_t t = 0; t < frame.tiles.size(); ++t) {
    if (frame.owners[t] < 0) continue;
    const auto owner = static_cast<std::size_t>(owners[t]);
    TileReport tile = frame.tiles[t];
    tile.tile = static_cast<std::int32_t>(t);
    const double quality = ranks[owner].quality();
    if (!ranks[owner].as_recorded && tile.cost > 0 && quality > 0) {
      const double cost = work_at_weight_1(tile) / quality;
      const double triangles = std::min(std::round(tile.triangles * cost / tile.cost), 1e9);
      tile.cost = cost;
      tile.triangles = static_cast<std::int32_t>(triangles);
      tile.total_weight = triangles * quality;
    }
    figures[owner].push_back(tile);
  }
  return figures;
}

}  // namespace pprt
