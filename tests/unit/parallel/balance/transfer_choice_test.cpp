#include "parallel/balance/transfer_choice.h"

#include <catch2/catch.hpp>

namespace pprt::transfer_choice_test {
namespace {

// Three ranks side by side on 9 x 3 tiles, three columns each.
Partition thirds() {
  Partition partition{TileGrid(90, 30, 10), 3, std::vector<std::int32_t>(27), std::vector<std::uint64_t>(27)};
  for (std::size_t tile = 0; tile < 27; ++tile)
    partition.owner[tile] = static_cast<std::int32_t>(tile % 9 / 3);
  return partition;
}

// Rank 1 is behind both others, rank 2 is farthest ahead.
TransferInputs inputs() {
  const auto taker = [](std::int32_t rank, double future_cost) {
    return PossibleTaker{
        .rank = rank,
        .progress = {.mean_weight = 0.1, .target_weight = 0.0625, .future_cost = future_cost},
        .giver_cost = 1000};
  };
  return {.mean_weight = 1, .noise = 0, .most_samples = 1e9, .takers = {taker(0, 500), taker(2, 100)}};
}

TileOffers hundred_each(const PossibleTaker&) {
  return [](int) { return TileOffer{.future_cost = 100, .samples = 0, .known_to_taker = 0}; };
}

}  // namespace

TEST_CASE(
    "transfer choice: the neighbour that is farthest ahead gets tiles first, and one that is behind gets "
    "none") {
  const std::vector<PossibleTaker> ahead = takers_ahead({}, inputs());
  REQUIRE(ahead.size() == 2);
  CHECK((ahead[0].rank == 2 && ahead[1].rank == 0));
  const std::vector<GivenTile> given = choose_tiles({}, thirds(), 1, inputs(), hundred_each);
  REQUIRE(given.size() >= 2);
  CHECK((given.front().taker == 2 && given.back().taker == 0));
  for (const GivenTile& g : given) CHECK(g.tile % 9 == (g.taker == 2 ? 5 : 3));  // at the borders
  TransferInputs level = inputs();
  level.mean_weight = 0.05;
  CHECK(takers_ahead({}, level).empty());
}

}  // namespace pprt::transfer_choice_test
