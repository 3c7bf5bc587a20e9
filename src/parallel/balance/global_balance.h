// Global balancing: the master repartitions the image from what every tile has cost (paper s. 4.4, 4.5).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/protocol/messages.h"
#include "parallel/protocol/tile_cost.h"
#include "parallel/settings/session_settings.h"
#include "pipeline/core/tile_grid.h"
#include "pipeline/sampling/sampler_traits.h"

namespace pprt {

// Dev / AvgWeight of s. 4.5: standard deviation by mean of the ranks' mean weights, over the ranks that have
// triangles. `of_rank[k]` are rank k's tiles.
double imbalance(std::span<const std::vector<TileReport>> of_rank);

// Returns what each tile of the grid took; zero for tiles that nobody reported.
std::vector<TileEstimate> tile_estimates(const TileGrid& grid,
                                         std::span<const std::vector<TileReport>> of_rank);

// Returns Cost(i) of s. 4.4 for every tile of the grid, work units: bringing it to the mean weight A of the
// whole image, its reconstruction and its preparation. Tiles that nobody reported cost the mean of the
// others.
std::vector<double> predicted_costs(const TileGrid& grid, std::span<const std::vector<TileReport>> of_rank);

// What the ranks report of a frame.
struct FrameReports {
  bool is_whole = true;          // all have: else it says nothing of the balance
  std::uint32_t generation = 0;  // of its partition
  bool accumulates = false;      // its samples are those of the frames before, too
  std::uint64_t samples = 0;
  std::vector<std::vector<TileReport>> tiles;  // per rank
  std::vector<double> speeds;                  // per rank: the reciprocals of their paces
};

// Turns the reports of a delivered frame into a new partition for the next order, where the mode asks for it.
class GlobalBalancer {
 public:
  // `units_per_frame`: work units that a rank can do in one frame's period; with a rate only.
  GlobalBalancer(const SessionSettings& settings, const SamplerTraits& traits, const TileGrid& grid,
                 int ranks, double units_per_frame)
      : settings_(settings), traits_(traits), grid_(grid), ranks_(ranks), units_per_frame_(units_per_frame) {}

  // Whether this mode of balancing makes partitions.
  bool repartitions() const {
    return settings_.balance == BalanceMode::kGlobal || settings_.balance == BalanceMode::kCombined;
  }

  // Considers the reports of a frame that is delivered.
  void consider(FrameReports frame);

  // Gives the tiles of the ranks that are lost to the others, by what is known of costs and speeds. `lost`:
  // all of them.
  void take_over(std::span<const std::int32_t> lost);

  // Puts the new partition, if there is one, into the order, and the generation in force. A partition whose
  // samples would have to be handed over is dropped where that costs too much. So is one that was made from
  // the samples of many frames, where the picture begins anew and the sampler's other tiles are costly then.
  void add_partition(FrameOrder& order);

  // Per rank: what the tiles that the order's new partition gives to it were found to be, ascending by tile.
  std::vector<std::vector<TileEstimate>> estimates_for(const FrameOrder& order) const;

 private:
  void make_partition(const std::vector<double>& speeds);
  bool is_useful_for(const FrameOrder& order) const;
  bool can_afford_to_hand_over() const;

  SessionSettings settings_;
  SamplerTraits traits_;
  TileGrid grid_;
  int ranks_;
  double units_per_frame_;
  FrameReports latest_;                    // whole ones
  std::vector<std::int32_t> next_owners_;  // of a new partition, for the next order
  std::vector<TileEstimate> found_;        // per tile, what that partition stands on
  std::vector<double> handed_over_;  // per rank: samples that it will have to take in with that partition
  bool accumulated_ = false;         // the frame that it was made from
  std::uint32_t generation_ = 0;     // of the partition ordered last
};

}  // namespace pprt
