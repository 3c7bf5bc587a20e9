#include "parallel/balance/transfer_choice.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include "parallel/clock/work_units.h"

namespace pprt {
namespace {

std::vector<TileRun> runs_of(const Partition& partition, int rank) {
  std::vector<TileRun> runs;
  for (std::int32_t tile = 0; tile < partition.grid.tile_count(); ++tile) {
    if (partition.owner[static_cast<std::size_t>(tile)] != rank) continue;
    if (runs.empty() || runs.back().first + runs.back().count != tile) runs.push_back({tile, 0});
    ++runs.back().count;
  }
  return runs;
}

// Gives the neighbours the tiles that the giver took for theirs.
void apply_view(const TransferChoice& recorded, Partition& partition) {
  constexpr std::int32_t kNobody = -1;
  for (const RecordedTaker& taker : recorded.takers) {
    std::replace(partition.owner.begin(), partition.owner.end(), taker.rank, kNobody);
  }
  for (const RecordedTaker& taker : recorded.takers) {
    for (const TileRun& run : taker.tiles) {
      const auto begin = partition.owner.begin() + run.first;
      std::replace_if(
          begin, begin + run.count, [&](std::int32_t owner) { return owner != recorded.giver; }, taker.rank);
    }
  }
}

TileOffers offers_in(const TransferChoice& recorded, int taker) {
  std::map<int, TileOffer> offers;
  for (const RecordedTaker& known : recorded.takers) {
    if (known.rank != taker) continue;
    for (const RecordedOffer& o : known.offers) offers.emplace(o.tile, o.offer);
  }
  return [offers = std::move(offers)](int tile) {
    // Too big a transfer for anyone.
    constexpr TileOffer kUnknown{.future_cost = std::numeric_limits<double>::infinity()};
    const auto found = offers.find(tile);
    return found == offers.end() ? kUnknown : found->second;
  };
}

}  // namespace

std::vector<PossibleTaker> takers_ahead(const LocalBalanceSettings& settings, const TransferInputs& inputs) {
  std::vector<PossibleTaker> ahead;
  for (const PossibleTaker& taker : inputs.takers) {
    if (should_give(settings, inputs.quality, taker.giver_cost, inputs.noise, taker.progress))
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

std::vector<GivenTile> TransferRecord::choose(const LocalBalanceSettings& settings,
                                              const Partition& partition, int giver,
                                              const TransferInputs& inputs, const OffersTo& offers_to) {
  TransferChoice choice{.giver = giver, .round = round, .inputs = inputs};
  std::map<int, std::map<int, TileOffer>> asked;  // by taker and tile
  const OffersTo recording = [&](const PossibleTaker& taker) {
    choice.takers.push_back({.rank = taker.rank, .tiles = runs_of(partition, taker.rank)});
    return [offer = offers_to(taker), &known = asked[taker.rank]](int tile) {
      return known.try_emplace(tile, offer(tile)).first->second;
    };
  };
  choice.given = choose_tiles(settings, partition, giver, inputs, recording);
  for (RecordedTaker& taker : choice.takers) {
    for (const auto& [tile, offer] : asked[taker.rank]) taker.offers.push_back({tile, offer});
  }
  std::vector<GivenTile> given = choice.given;
  if (!choice.takers.empty()) choices.push_back(std::move(choice));
  return given;
}

std::vector<GivenTile> choose_again(const LocalBalanceSettings& settings, const Partition& partition,
                                    const TransferChoice& recorded) {
  Partition view = partition;
  apply_view(recorded, view);
  return choose_tiles(settings, std::move(view), recorded.giver, recorded.inputs,
                      [&](const PossibleTaker& taker) { return offers_in(recorded, taker.rank); });
}

}  // namespace pprt
