#include "parallel/balance/balancer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "parallel/settings/work_units.h"

namespace pprt {

Balancer::Balancer(int rank, int ranks, const CostEstimator& costs)
    : rank_(rank), costs_(costs), theirs_(static_cast<std::size_t>(ranks)) {}

void Balancer::begin_frame(double pace) {
  pace_ = pace;
  std::fill(theirs_.begin(), theirs_.end(), RankProgress());
}

RankProgress Balancer::progress(const RegionQuality& refined, double elapsed) const {
  const double weight = refined.mean_weight;
  if (weight <= 0) return {};
  // The mean weight falls as the reciprocal of the samples: what it will be when the frame ends.
  const double target = target_weight_for(weight * elapsed);
  return {.mean_weight = weight,
          .target_weight = target,
          .future_cost = own_future_cost(refined, target),
          .pace = pace_};
}

// In time.
double Balancer::own_future_cost(const RegionQuality& refined, double weight) const {
  return pace_ * costs_.future_cost_of_region(refined, weight);
}

bool Balancer::wants_to_give(const RegionQuality& refined, const std::vector<int>& neighbours, double elapsed,
                             bool is_giving) const {
  std::vector<RankProgress> theirs;
  theirs.reserve(neighbours.size());
  for (const int rank : neighbours) theirs.push_back(theirs_[static_cast<std::size_t>(rank)]);
  const double load =
      load_by_neighbours(theirs, [&](double target) { return own_future_cost(refined, target); });
  return should_begin_to_give(settings_, load, relative_noise(refined, elapsed), is_giving);
}

// All neighbours that may be given tiles, whether or not they should be.
TransferInputs Balancer::inputs(const RegionQuality& refined, const std::vector<int>& neighbours,
                                double elapsed, const TransferHandshake& handshake,
                                double most_samples) const {
  TransferInputs inputs{.mean_weight = refined.mean_weight,
                        .noise = relative_noise(refined, elapsed),
                        .most_samples = most_samples};
  for (const int rank : neighbours) {
    const RankProgress& theirs = theirs_[static_cast<std::size_t>(rank)];
    if (!handshake.accepts(rank) || !handshake.has_confirmed_transfers(rank) || theirs.mean_weight <= 0)
      continue;
    inputs.takers.push_back({rank, theirs, own_future_cost(refined, theirs.target_weight)});
  }
  return inputs;
}

TileOffers Balancer::offers_to(const PossibleTaker& taker, const RegionQuality& refined,
                               const KnownRanks& others) const {
  const double mean_pace = 0.5 * (pace_ + taker.progress.pace), target = taker.progress.target_weight;
  return [this, mean_pace, target, &refined, known = others.known_in_tiles(taker.rank),
          all = others.known_in_tiles(rank_)](int tile) {
    const auto t = static_cast<std::size_t>(tile);
    return TileOffer{.future_cost = mean_pace * costs_.future_cost(refined, tile, target),
                     .samples = static_cast<double>(all[t]),
                     .known_to_taker = static_cast<double>(known[t])};
  };
}

std::vector<TileTransfer> Balancer::choose_transfers(const RegionQuality& refined, const KnownRanks& others,
                                                     const TransferHandshake& handshake, double elapsed,
                                                     double most_samples) const {
  std::vector<TileTransfer> transfers;
  if (!handshake.may_transfer()) return transfers;
  const Partition& partition = others.partition;
  const TransferInputs going_by = inputs(refined, others.ranks_beside, elapsed, handshake, most_samples);
  const auto offers = [&](const PossibleTaker& taker) { return offers_to(taker, refined, others); };
  for (const auto& [tile, taker] : choose_tiles(settings_, partition, rank_, going_by, offers)) {
    transfers.push_back({.tile = tile,
                         .owner = taker,
                         .version = partition.version[static_cast<std::size_t>(tile)] + 1,
                         .now = costs_.now(tile),
                         .last = costs_.last(tile)});
  }
  return transfers;
}

}  // namespace pprt
