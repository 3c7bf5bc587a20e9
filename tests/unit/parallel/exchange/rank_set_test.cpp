// Sets of ranks, against those of the standard library.
#include "parallel/exchange/rank_set.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <vector>

namespace pprt::rank_set_test {

TEST_CASE("rank sets: each holds what was added to it, of as many ranks as there are") {
  for (const int ranks : {1, 2, 63, 64, 65, 128, 200}) {
    std::mt19937 random(static_cast<unsigned>(ranks));
    RankSets sets(ranks);
    for (int round = 0; round < 2; ++round) {
      std::vector<std::set<int>> expected;
      for (std::size_t i = 0; i < 20; ++i) {
        REQUIRE(sets.size() == i);
        sets.append_empty();
        expected.emplace_back();
        for (int k = 0; k < 8; ++k) {
          const std::size_t set = random() % (i + 1);
          const int rank = static_cast<int>(random() % static_cast<unsigned>(ranks));
          sets.add(set, rank), expected[set].insert(rank);
        }
      }
      int wrong = 0;
      for (std::size_t i = 0; i < expected.size(); ++i)
        for (int rank = 0; rank < ranks; ++rank)
          wrong += sets.contains(i, rank) != (expected[i].count(rank) != 0) ? 1 : 0;
      INFO(ranks << " ranks");
      CHECK(wrong == 0);
      sets.clear();
      CHECK(sets.size() == 0);
    }
  }
}

}  // namespace pprt::rank_set_test
