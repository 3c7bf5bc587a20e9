#include "parallel/balance/transfer_choice.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "parallel/settings/work_units.h"

namespace pprt {
std::vector<PossibleTaker> takers_ahead(const LocalBalanceSettings& settings, const TransferInputs& inputs) {
  std::vector<PossibleTaker> ahead;
  for (const PossibleTaker& taker : inputs.takers) {
    if (should_give(settings, inputs.mean_weight, taker.giver_cost, inputs.noise, taker.progress))
      ahead.push_back(taker);
  }
  const auto order = [](const PossibleTaker& taker) {
    return std::pair(taker.progress.future_cost / taker.giver_cost, taker.rank);
  };
  std::sort(ahead.begin(), ahead.end(),
            [&](const PossibleTaker& a, const PossibleTaker& b) { return order(a) < order(b); });
  return ahead;
}

std::vector<GivenTile> choose_tiles(const LocalBalanceSettings& settings, Partition partition, int giver,
                                    const TransferInputs& inputs, const OffersTo& offers_to) {
  std::vector<GivenTile> given;
  for (const PossibleTaker& taker : takers_ahead(settings, inputs)) {
    const TransferBounds bounds{
        .difference = taker.giver_cost - taker.progress.future_cost,
        .insertion_cost = taker.progress.pace * static_cast<double>(price(Work::kReceivedSample)),
        .most_samples = inputs.most_samples};
    // None where the taker touches this region at a corner only, or where every tile is too big a transfer.
    for (const int tile : tiles_to_give(settings, partition, giver, taker.rank, bounds, offers_to(taker))) {
      given.push_back({tile, taker.rank});
      partition.owner[static_cast<std::size_t>(tile)] = taker.rank;
    }
  }
  return given;
}

}  // namespace pprt
