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

// Returns who owned which tile, as the giver knew it: its own tiles and those of the neighbours ahead. The
// others are nobody's.
Partition view_of(const TransferChoice& recorded, const TileGrid& grid, int ranks) {
  const auto tiles = static_cast<std::size_t>(grid.tile_count());
  Partition view{grid, ranks, std::vector<std::int32_t>(tiles, -1), std::vector<std::uint64_t>(tiles, 0)};
  const auto own = [&](std::int32_t rank, const std::vector<TileRun>& runs) {
    for (const TileRun& run : runs) std::fill_n(view.owner.begin() + run.first, run.count, rank);
  };
  for (const RecordedTaker& taker : recorded.takers) own(taker.rank, taker.tiles);
  own(recorded.giver, recorded.tiles);
  return view;
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
  TransferChoice choice{.giver = giver, .round = round, .tiles = runs_of(partition, giver), .inputs = inputs};
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

std::vector<GivenTile> choose_again(const LocalBalanceSettings& settings, const TileGrid& grid, int ranks,
                                    const TransferChoice& recorded) {
  return choose_tiles(settings, view_of(recorded, grid, ranks), recorded.giver, recorded.inputs,
                      [&](const PossibleTaker& taker) { return offers_in(recorded, taker.rank); });
}

}  // namespace pprt
