#include "study/balance/figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "parallel/balance/global_balance.h"
#include "parallel/session.h"

namespace pprt {
namespace {

void add_loads(const TileGrid& grid, const TracedFrame& frame, FrameFigures& figures) {
  double sum = 0, squares = 0, most = 0;
  const std::vector<double> of_ranks = loads(grid, frame, figures.owners);
  for (const double load : of_ranks) sum += load, squares += load * load, most = std::max(most, load);
  const auto ranks = static_cast<double>(of_ranks.size());
  const double mean = sum / ranks;
  if (!(mean > 0)) return;
  figures.deviation = std::sqrt(std::max(0.0, squares / ranks - mean * mean)) / mean;
  figures.worst = most / mean;
}

}  // namespace

std::vector<double> tile_costs(const TileGrid& grid, const TracedFrame& frame) {
  std::vector<std::vector<TileReport>> of_rank(frame.ranks.size());
  for (std::size_t tile = 0; tile < frame.tiles.size(); ++tile) {
    if (frame.owners[tile] >= 0)
      of_rank[static_cast<std::size_t>(frame.owners[tile])].push_back(frame.tiles[tile]);
  }
  return predicted_costs(grid, of_rank);
}

std::vector<double> loads(const TileGrid& grid, const TracedFrame& frame,
                          const std::vector<std::int32_t>& owners) {
  const std::vector<double> costs = tile_costs(grid, frame);
  std::vector<double> of_rank(frame.ranks.size(), 0);
  for (std::size_t tile = 0; tile < costs.size(); ++tile) {
    const auto owner = static_cast<std::size_t>(owners[tile]);
    of_rank[owner] += frame.ranks[owner].pace * costs[tile];
  }
  std::vector<double> loads;
  for (std::size_t rank = 0; rank < of_rank.size(); ++rank) {
    const auto& lost = frame.lost_ranks;
    if (std::find(lost.begin(), lost.end(), static_cast<std::int32_t>(rank)) == lost.end())
      loads.push_back(of_rank[rank]);
  }
  return loads;
}

std::vector<FrameFigures> figures_of(const BalanceTrace& run) {
  std::vector<FrameFigures> figures;
  std::vector<std::int32_t> owners = equal_areas(run.header.grid, run.header.ranks).owner;
  for (const TracedFrame& frame : run.frames) {
    FrameFigures& of_frame = figures.emplace_back(
        FrameFigures{.frame = frame.number, .owners = owners, .repartitioned = frame.repartitioned});
    for (std::size_t tile = 0; tile < owners.size(); ++tile) {
      if (frame.owners[tile] < 0 || frame.owners[tile] == owners[tile]) continue;
      of_frame.owners[tile] = frame.owners[tile];
      ++of_frame.moved;
    }
    for (const TransferChoice& choice : frame.transfers)
      of_frame.given += static_cast<int>(choice.given.size());
    owners = of_frame.owners;
    add_loads(run.header.grid, frame, of_frame);
  }
  return figures;
}

}  // namespace pprt
