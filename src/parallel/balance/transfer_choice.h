// Which tiles a rank gives to which neighbours (paper s. 3.6, 4.3). The choice is a function of plain values.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "parallel/balance/local_balance.h"
#include "parallel/balance/partition.h"
#include "parallel/protocol/tile_cost.h"

namespace pprt {

// A neighbour that may be given tiles: it has reported progress, and the handshake allows a transfer.
struct PossibleTaker {
  std::int32_t rank = 0;
  RankProgress progress = {};  // its own
  double giver_cost = 0;       // the giver's future cost at progress.target_weight: time
};

// What a rank goes by when it chooses transfers.
struct TransferInputs {
  double mean_weight = 0;   // Q_k of the giver
  double noise = 0;         // relative_noise() of its region
  double most_samples = 0;  // that a taker need take in
  std::vector<PossibleTaker> takers = {};
};

// Returns what the giver knows of its tiles, for transfers to one neighbour. Asked once for each neighbour
// that should be given tiles, and then for tiles of the giver only.
using TileOffers = std::function<TileOffer(int tile)>;
using OffersTo = std::function<TileOffers(const PossibleTaker& taker)>;

// Returns the neighbours that the giver should give to, the one that is farthest ahead first.
std::vector<PossibleTaker> takers_ahead(const LocalBalanceSettings& settings, const TransferInputs& inputs);

// Returns the tiles to give, all of one taker's together. `partition`: as the giver knows it.
std::vector<GivenTile> choose_tiles(const LocalBalanceSettings& settings, Partition partition, int giver,
                                    const TransferInputs& inputs, const OffersTo& offers_to);

}  // namespace pprt
