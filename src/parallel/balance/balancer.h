// One rank's part in local balancing: what its neighbours report, and which tiles to give them (paper
// s. 3.6).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "parallel/balance/cost_estimator.h"
#include "parallel/balance/local_balance.h"
#include "parallel/balance/transfer_choice.h"
#include "parallel/balance/transfer_handshake.h"
#include "parallel/protocol/tile_cost.h"
#include "pipeline/core/region_quality.h"

namespace pprt {

// What a rank knows of the others around it.
struct KnownRanks {
  const Partition& partition;
  const std::vector<int>& ranks_beside;  // own a tile beside one of the rank's; ascending
  std::function<std::vector<std::uint32_t>(int rank)>
      known_in_tiles;  // samples of each tile that a rank knows
};

// Decides; it neither sends tiles nor changes their owners.
class Balancer {
 public:
  // `costs`, the rank's own, must outlive the balancer.
  Balancer(int rank, int ranks, const CostEstimator& costs);

  // A frame begins: nothing is known of the neighbours' progress in it. `pace`: this rank's.
  void begin_frame(double pace);

  void receive(int from, const RankProgress& progress) { theirs_[static_cast<std::size_t>(from)] = progress; }

  // This rank's own progress, towards the target that its mean weight names. `elapsed`: share of the frame's
  // sampling time that has passed, in (0, 1].
  RankProgress progress(const RegionQuality& refined, double elapsed) const;

  // Whether tiles may still change hands in this frame. Later they have more samples to hand over, and their
  // new owner has less time to make use of them. Without a frame before to go by, knowing takes longer.
  bool is_early_enough(double elapsed) const {
    return elapsed <= (costs_.likeness() == FrameLikeness::kUnknown ? 0.75 : 0.5);
  }

  // Whether this rank has more to pay than its neighbours, by and large. Here and below `elapsed` is as in
  // progress().
  bool wants_to_give(const RegionQuality& refined, const std::vector<int>& neighbours, double elapsed,
                     bool is_giving) const;

  // The tiles to give to neighbours that accept tiles and are ahead, all of one neighbour's together. A
  // neighbour need not take in more than `most_samples`. Empty while the handshake forbids transfers.
  std::vector<TileTransfer> choose_transfers(const RegionQuality& refined, const KnownRanks& others,
                                             const TransferHandshake& handshake, double elapsed,
                                             double most_samples) const;

 private:
  double own_future_cost(const RegionQuality& refined, double weight) const;
  TransferInputs inputs(const RegionQuality& refined, const std::vector<int>& neighbours, double elapsed,
                        const TransferHandshake& handshake, double most_samples) const;
  TileOffers offers_to(const PossibleTaker& taker, const RegionQuality& refined,
                       const KnownRanks& others) const;

  LocalBalanceSettings settings_;
  int rank_;
  const CostEstimator& costs_;
  double pace_ = 1;
  std::vector<RankProgress> theirs_;  // per rank, in this frame
};

}  // namespace pprt
