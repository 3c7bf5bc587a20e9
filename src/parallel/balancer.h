// One rank's part in balancing: what its tiles cost, what its neighbours tell, which tiles it gives away.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/exchange.h"
#include "parallel/local_balance.h"
#include "parallel/tile_cost.h"
#include "pipeline/sample_mesh.h"

namespace pprt {

// Costs are work units under either clock: they need only be right in proportion, and counting them disturbs
// nothing.
class Balancer {
 public:
  Balancer(int rank, int ranks, int tile_count);

  // A frame begins; with a fresh triangulation what the tiles have cost becomes what they cost last.
  void begin_frame(bool fresh_mesh);

  void paid(int tile, double units) { now_[static_cast<std::size_t>(tile)].cost += units; }
  void heard(int from, const RankProgress& progress) { theirs_[static_cast<std::size_t>(from)] = progress; }
  void take(const TileGrant& grant);

  // This rank's own progress, towards the target that its quality names.
  RankProgress progress(const SampleMesh& mesh) const;

  // Tiles to give to a neighbour that is ahead, if this rank is the last among its neighbours: so two
  // neighbours never give at the same time, and a region cannot fall apart while it receives. Their samples
  // are put into the exchange's outbox; the caller sends the grants to every rank and makes them true.
  std::vector<TileGrant> give(const SampleMesh& mesh, SampleExchange& exchange, double most_samples);

  // Remembers the mean weights that the frame has led to, and tells what every tile of the region took.
  std::vector<TileReport> report(const SampleMesh& mesh);

 private:
  double future_cost_of(const SampleMesh& mesh, int tile, double quality) const;
  double future_cost_of_region(const SampleMesh& mesh, double quality) const;
  std::vector<int> neighbours_ahead(const SampleMesh& mesh, const std::vector<int>& neighbours) const;
  std::vector<int> tiles_for(const SampleMesh& mesh, const SampleExchange& exchange, int taker,
                             double most_samples) const;

  LocalBalanceSettings settings_;
  int rank_;
  std::vector<TileEstimate> now_;  // per tile; right for own ones
  std::vector<TileEstimate> last_;
  std::vector<RankProgress> theirs_;  // per rank, in this frame
};

}  // namespace pprt
