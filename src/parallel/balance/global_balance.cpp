#include "parallel/balance/global_balance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "parallel/balance/cost_estimator.h"
#include "parallel/balance/partition.h"
#include "parallel/settings/work_units.h"

namespace pprt {
namespace {

// In `combined` the image is repartitioned when the ranks' mean weights deviate by more than this share of
// their mean: more where regions have few triangles, whose mean weights are uncertain. Found by measurement
// (docs/decisions/0009-balancing.md).
double imbalance_trigger(std::span<const std::vector<TileReport>> of_rank) {
  double triangles = 0;
  for (const std::vector<TileReport>& tiles : of_rank) {
    for (const TileReport& t : tiles) triangles += t.triangles;
  }
  const double of_region = triangles / static_cast<double>(of_rank.size());
  return 0.1 + 4 / std::sqrt(std::max(of_region, 1.0));
}

}  // namespace

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
      cost = sampling + reconstruction_cost(grid, t.tile) + t.preparation;
      sum += cost;
      ++known;
    }
  }
  for (double& cost : costs) {
    if (cost < 0) cost = known > 0 ? sum / known : 1;
  }
  return costs;
}

void GlobalBalancer::consider(FrameReports frame) {
  if (!frame.is_whole) return;
  latest_ = std::move(frame);
  if (!repartitions()) return;
  const bool always = settings_.balance == BalanceMode::kGlobal;
  if (ranks_ == 1) return;
  // A partition is in force two frames after the one that it was made from. The frame between does not show
  // yet what it brings; where samples would be handed over once more, it is not answered.
  const bool is_answered = latest_.accumulates && latest_.generation != generation_;
  if (!always && (is_answered || imbalance(latest_.tiles) <= imbalance_trigger(latest_.tiles))) return;
  make_partition(latest_.speeds);
}

void GlobalBalancer::take_over(std::span<const std::int32_t> lost) {
  std::vector<double> speeds = latest_.speeds;
  speeds.resize(static_cast<std::size_t>(ranks_), 1);
  for (const std::int32_t rank : lost) speeds[static_cast<std::size_t>(rank)] = 0;
  make_partition(speeds);
  accumulated_ = false;  // what was sampled is lost, too: the picture begins anew
}

void GlobalBalancer::make_partition(const std::vector<double>& speeds) {
  accumulated_ = latest_.accumulates;
  next_owners_ = bisect(grid_, predicted_costs(grid_, latest_.tiles), speeds).owner;
  found_ = tile_estimates(grid_, latest_.tiles);
  handed_over_.assign(static_cast<std::size_t>(ranks_), 0);
  for (std::size_t rank = 0; rank < latest_.tiles.size(); ++rank) {
    for (const TileReport& tile : latest_.tiles[rank]) {
      const auto taker = static_cast<std::size_t>(next_owners_[static_cast<std::size_t>(tile.tile)]);
      // A triangulation has about two triangles a sample.
      if (taker != rank) handed_over_[taker] += 0.5 * tile.triangles;
    }
  }
}

// Cast samples are reinserted anyhow, by their new owners.
void GlobalBalancer::add_partition(FrameOrder& order) {
  if (!is_useful_for(order)) next_owners_.clear();
  if (!next_owners_.empty()) ++generation_;
  order.owners = std::exchange(next_owners_, {});
  order.columns = order.owners.empty() ? 0 : grid_.columns();
  order.generation = generation_;
}

bool GlobalBalancer::is_useful_for(const FrameOrder& order) const {
  if (order.carry == Carry::kAccumulate) return !settings_.keep_samples || can_afford_to_hand_over();
  return !accumulated_ || traits_.costs_outlast_rest;
}

// Whether every rank can take in the samples of its new tiles in a twentieth of a frame; their former owner
// has to look for them, too. Where a camera has rested for long there are more samples than that: then local
// balancing works alone.
bool GlobalBalancer::can_afford_to_hand_over() const {
  if (next_owners_.empty() || settings_.frames_per_second <= 0) return true;
  const auto pixels =
      static_cast<std::uint64_t>(settings_.width) * static_cast<std::uint64_t>(settings_.height);
  if (latest_.samples > pixels) return false;  // fine enough as it is
  const double most = *std::max_element(handed_over_.begin(), handed_over_.end());
  return most * static_cast<double>(price(Work::kReceivedSample)) <= 0.05 * units_per_frame_;
}

std::vector<std::vector<TileEstimate>> GlobalBalancer::estimates_for(const FrameOrder& order) const {
  std::vector<std::vector<TileEstimate>> estimates(static_cast<std::size_t>(ranks_));
  for (std::size_t tile = 0; tile < order.owners.size(); ++tile) {
    estimates[static_cast<std::size_t>(order.owners[tile])].push_back(found_[tile]);
  }
  return estimates;
}

}  // namespace pprt
