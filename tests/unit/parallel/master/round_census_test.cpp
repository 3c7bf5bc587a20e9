// How many bundles a rank has to wait for on the work clock.
#include "parallel/master/round_census.h"

#include <catch2/catch.hpp>
#include <vector>

#include "parallel/network/local_communicator.h"
#include "parallel/protocol/inbox.h"
#include "parallel/protocol/messages.h"

namespace pprt::round_census_test {
namespace {

constexpr int kRanks = 3;

struct Trial {
  LocalNetwork network{kRanks};
  std::vector<LocalCommunicator> ranks{{network, 0}, {network, 1}, {network, 2}};
  RoundCensus census{ranks[0]};

  void sent(int from, int round, std::vector<std::int32_t> receivers) {
    census.receive({from, Tag::kRoundSent, encode(RoundSent{4, round, std::move(receivers)})});
  }

  // Empty: the rank has not been told.
  std::optional<std::size_t> due(int rank, int round) {
    Inbox inbox(ranks[static_cast<std::size_t>(rank)], 0.1, [](const Message&) {});
    inbox.pump();
    return inbox.bundles_due(4, round);
  }
};

TEST_CASE("round census: all are told what comes to them once the last has sent its bundles") {
  Trial trial;
  trial.sent(1, 7, {0, 2});
  trial.sent(0, 7, {});
  CHECK_FALSE(trial.due(2, 7));
  trial.sent(2, 7, {0});
  CHECK(trial.due(0, 7) == 2);
  CHECK(trial.due(1, 7) == 0);
  CHECK(trial.due(2, 7) == 1);
}

TEST_CASE("round census: each round counts anew") {
  Trial trial;
  for (const int round : {7, 8}) {
    for (int rank = 0; rank < kRanks; ++rank) trial.sent(rank, round, {1});
    CHECK_FALSE(trial.due(0, round - 1));
    CHECK(trial.due(1, round) == 3);
    CHECK(trial.due(2, round) == 0);
  }
}

TEST_CASE("round census: a bundle to nobody is an error") {
  Trial trial;
  CHECK_THROWS_AS(trial.sent(1, 7, {kRanks}), ProtocolError);
  CHECK_THROWS_AS(trial.sent(1, 7, {-1}), ProtocolError);
}

}  // namespace
}  // namespace pprt::round_census_test
