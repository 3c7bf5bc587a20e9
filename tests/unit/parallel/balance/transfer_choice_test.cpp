#include "parallel/balance/transfer_choice.h"

#include <catch2/catch.hpp>
#include <set>
#include <utility>

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
  // The first of two that are as far ahead comes first, whichever has reported first.
  TransferInputs even = inputs();
  std::swap(even.takers[0], even.takers[1]);
  for (PossibleTaker& taker : even.takers) taker.progress.future_cost = 200;
  const std::vector<PossibleTaker> by_rank = takers_ahead({}, even);
  REQUIRE(by_rank.size() == 2);
  CHECK((by_rank[0].rank == 0 && by_rank[1].rank == 2));
}

TEST_CASE("transfer choice: what a tile's samples cost the taker is by the taker's pace") {
  // Two tiles at the ends of the border: the first relieves the giver of more, and has more samples.
  const auto first_given = [](double pace) {
    TransferInputs one = inputs();
    one.takers = {one.takers[1]};
    one.takers[0].giver_cost = 500'000, one.takers[0].progress.future_cost = 0;
    one.takers[0].progress.pace = pace;
    const auto offers = [](const PossibleTaker&) {
      return [](int tile) {
        const double samples = tile == 5 ? 100 : tile == 23 ? 10 : 1e12;  // more than a taker takes in
        return TileOffer{.future_cost = tile == 5 ? 100'000.0 : 60'000.0, .samples = samples};
      };
    };
    const std::vector<GivenTile> given = choose_tiles({}, thirds(), 1, one, offers);
    return given.empty() ? -1 : given[0].tile;
  };
  CHECK(first_given(0.1) == 5);  // 580 units a sample: 5,800 of 100,000
  CHECK(first_given(1) == 23);   // 58,000 of 100,000, and 5,800 of 60,000
}

TEST_CASE("transfer choice: three tenths of what the giver has more to pay move at once") {
  TransferInputs one = inputs();
  one.takers = {one.takers[1]};
  const auto given_with = [&](double giver_cost) {
    one.takers[0].giver_cost = giver_cost, one.takers[0].progress.future_cost = 100;
    return choose_tiles({}, thirds(), 1, one, hundred_each).size();
  };
  // A tile costs 100, of nine a quarter may go, and one that is half as much again as the rest goes, too.
  CHECK(given_with(100 + 210) == 0);
  CHECK(given_with(100 + 230) == 1);
  CHECK(given_with(100 + 330) == 1);
  CHECK(given_with(100 + 1000) == 2);
}

TEST_CASE("transfer choice: no tile is given twice, and the giver stays in one piece") {
  // A column of tiles between two takers, that both border on all of it.
  Partition partition{TileGrid(30, 160, 10), 3, {}, std::vector<std::uint64_t>(48)};
  for (int tile = 0; tile < 48; ++tile) partition.owner.push_back(tile % 3 == 0 ? 0 : tile % 3 == 1 ? 1 : 2);
  TransferInputs both = inputs();
  for (PossibleTaker& taker : both.takers) taker.giver_cost = 1e6;
  const std::vector<GivenTile> given = choose_tiles({}, partition, 1, both, hundred_each);
  CHECK(given.size() == 4 + 3);  // a quarter of sixteen, then of twelve
  std::set<int> tiles;
  for (const GivenTile& g : given) {
    CHECK(tiles.insert(g.tile).second);
    partition.owner[static_cast<std::size_t>(g.tile)] = g.taker;
  }
  CHECK(is_connected(partition, 1));
}

}  // namespace pprt::transfer_choice_test
