// What each clock's policy awaits, takes and delays.
#include "parallel/clock/exchange_policy.h"

#include <catch2/catch.hpp>

#include "parallel/clock/make_clocks.h"
#include "parallel/network/local_communicator.h"

namespace pprt::exchange_policy_test {
namespace {

constexpr int kRanks = 3;

// Rank 0's inbox, and what ranks 1 and 2 send.
struct Network {
  LocalNetwork network{kRanks};
  LocalCommunicator receiver{network, 0};
  LocalCommunicator senders[2] = {{network, 1}, {network, 2}};
  Inbox inbox{receiver, 0.1, [](const Message&) {}};

  void send(int from, const Bundle& bundle) {
    senders[from - 1].send(0, Tag::kBundle, encode(bundle));
    inbox.pump();
  }

  // Rank 0 is told how many bundles come to it in a round of frame 0.
  void count(int round, std::uint32_t bundles) {
    receiver.send(0, Tag::kRoundDue, encode(RoundDue{.round = round, .bundles = bundles}));
    inbox.pump();
  }
};

std::unique_ptr<ExchangePolicy> policy(ClockKind clock, double frames_per_second = 10) {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.clock = clock;
  settings.frames_per_second = frames_per_second;
  settings.budget_units = 24'000'000;  // a megaunit a round
  settings.machine = {.units_per_second = 1e9, .latency_s = 0.0005, .bytes_per_second = 1e6};
  return make_exchange_policy(settings, kRanks);
}

Sample sample_with(SampleId id) {
  Sample s;
  s.id = id;
  return s;
}

std::size_t samples_in(const std::vector<Inbox::Arrived>& bundles) {
  std::size_t count = 0;
  for (const Inbox::Arrived& a : bundles) count += a.bundle.samples.size();
  return count;
}

TEST_CASE("exchange policy: on the work clock a round is ready when all bundles that were counted are here") {
  Network network;
  const auto lockstep = policy(ClockKind::kWork), free = policy(ClockKind::kWall);
  const ExchangeRound at{.frame_index = 0, .begun_in = 0, .round = 3};
  CHECK(lockstep->missing(network.inbox, at) == kUnknownNumber);
  CHECK(free->missing(network.inbox, at) == 0);
  network.send(1, {.round = 3});
  network.send(2, {.round = 4});
  CHECK(lockstep->missing(network.inbox, at) == kUnknownNumber);
  network.count(2, 2);
  CHECK(lockstep->missing(network.inbox, at) == kUnknownNumber);
  network.count(3, 2);
  CHECK(lockstep->missing(network.inbox, at) == 1);
  network.send(2, {.round = 3});
  CHECK(lockstep->missing(network.inbox, at) == 0);
  CHECK(lockstep->take_due(network.inbox, at).size() == 2);
  CHECK(network.inbox.bundles().size() == 1);  // of round 4
}

TEST_CASE("exchange policy: on the wall clock bundles of later frames and triangulations wait") {
  Network network;
  const auto free = policy(ClockKind::kWall);
  network.send(1, {.frame_index = 1, .begun_in = 0, .round = 9});
  network.send(1, {.frame_index = 2, .begun_in = 2, .round = 0});
  network.send(2, {.frame_index = 2, .begun_in = 1, .round = 5});
  CHECK(free->take_due(network.inbox, {.frame_index = 2, .begun_in = 1, .round = 1}).size() == 2);
  CHECK(network.inbox.bundles().size() == 1);
}

TEST_CASE(
    "exchange policy: seeds are awaited from peers for a tenth of a period, without a rate without end") {
  Network network;
  const ExchangeRound at{.frame_index = 0, .begun_in = 0, .round = kSeedRound};
  const std::vector<int> peers = {2};
  const auto with_rate = policy(ClockKind::kWall), without = policy(ClockKind::kWall, 0);
  CHECK(with_rate->missing_seeds(network.inbox, at, peers, 0.009) > 0);
  CHECK(with_rate->missing_seeds(network.inbox, at, peers, 0.011) == 0);
  CHECK(without->missing_seeds(network.inbox, at, peers, 1e6) > 0);
  network.send(1, {.round = kSeedRound});  // no peer
  CHECK(without->missing_seeds(network.inbox, at, peers, 0) > 0);
  network.send(2, {.round = kSeedRound});
  CHECK(without->missing_seeds(network.inbox, at, peers, 0) == 0);
  CHECK(with_rate->missing_seeds(network.inbox, at, peers, 0) == 0);
}

TEST_CASE(
    "exchange policy: the work clock delays samples by latency and by the bytes of a round, no other clock") {
  const auto lockstep = policy(ClockKind::kWork);  // a round takes a millisecond
  const ExchangeRound first{.frame_index = 0, .begun_in = 0, .round = 1}, next{.frame_index = 0, .round = 2};
  CHECK(lockstep->delivery_delay(1, first, 0) == 0);
  CHECK(lockstep->delivery_delay(1, first, 1000) ==
        1);  // half a millisecond of latency and one for the bytes
  CHECK(lockstep->delivery_delay(1, first, 1000) == 2);  // the others go first
  CHECK(lockstep->delivery_delay(1, next, 1000) == 1);
  CHECK(policy(ClockKind::kWall)->delivery_delay(1, first, 1'000'000) == 0);
}

TEST_CASE("exchange policy: the round in which delayed samples arrive has a bundle to arrive with") {
  const auto lockstep = policy(ClockKind::kWork);
  const auto at = [](int frame, int round) { return ExchangeRound{.frame_index = frame, .round = round}; };
  CHECK(lockstep->delivery_delay(2, at(0, 23), 2000) == 2);
  CHECK(lockstep->delivery_delay(1, at(0, 23), 0) == 2);  // nothing that could arrive
  CHECK_FALSE(lockstep->owes_bundle(2, at(0, 24)));
  CHECK_FALSE(lockstep->owes_bundle(1, at(1, 1)));
  CHECK(lockstep->owes_bundle(2, at(1, 1)));
  CHECK_FALSE(lockstep->owes_bundle(2, at(1, 1)));  // once
  CHECK(lockstep->delivery_delay(2, at(1, 1), 2000) == 2);
  lockstep->begin_picture();
  CHECK_FALSE(lockstep->owes_bundle(2, at(1, 3)));
}

TEST_CASE("exchange policy: delayed samples arrive in their round, in the next frame if need be, or never") {
  for (const bool new_triangulation : {false, true}) {
    Network network;
    const auto lockstep = policy(ClockKind::kWork);
    const auto take = [&](int frame, int round, const Bundle& from_1) {
      network.send(1, from_1);
      network.send(2, {.frame_index = frame, .round = round});
      return samples_in(lockstep->take_due(network.inbox, {.frame_index = frame, .round = round}));
    };
    CHECK(take(0, 23, {.round = 23, .rounds_under_way = 2, .samples = {sample_with(1)}}) == 0);
    CHECK(take(0, 24, {.round = 24, .samples = {sample_with(2)}}) == 1);
    if (new_triangulation) lockstep->begin_picture();
    CHECK(take(1, 1, {.frame_index = 1, .round = 1}) == (new_triangulation ? 0 : 1));
  }
}

TEST_CASE(
    "exchange policy: progress is due every other round of the work clock, every fourth of the wall clock") {
  const auto lockstep = policy(ClockKind::kWork), free = policy(ClockKind::kWall);
  for (int round = 1; round <= 12; ++round) {
    CHECK(lockstep->is_progress_due(round) == (round % 2 == 0));
    CHECK(free->is_progress_due(round) == (round % 4 == 0));
  }
}

TEST_CASE(
    "exchange policy: where messages come at any time idle ranks rest, and former owners send pixels too") {
  const auto lockstep = policy(ClockKind::kWork), free = policy(ClockKind::kWall);
  CHECK((free->rests_when_idle() && !lockstep->rests_when_idle()));
  CHECK((free->sends_substitute_pixels() && !lockstep->sends_substitute_pixels()));
  CHECK((!free->counts_bundles() && lockstep->counts_bundles()));
  const ExchangeRound at{.frame_index = 0, .begun_in = 0, .round = 1};
  CHECK_FALSE(free->owes_bundle(1, at));
}

TEST_CASE("exchange policy: without a rate a round has its fixed units, which a message takes longer than") {
  const ExchangeRound at{.frame_index = 0, .begun_in = 0, .round = 1};
  CHECK(policy(ClockKind::kWork, 10)->delivery_delay(1, at, 0) == 0);  // half of a millisecond
  CHECK(policy(ClockKind::kWork, 0)->delivery_delay(1, at, 0) == 2);   // twice a quarter
}

TEST_CASE("exchange policy: samples that were delayed join those of their sender in the round's order") {
  Network network;
  const auto lockstep = policy(ClockKind::kWork);
  const auto at = [](int round) { return ExchangeRound{.frame_index = 0, .round = round}; };
  network.send(2, {.round = 1, .rounds_under_way = 1, .samples = {sample_with(21)}});
  network.send(1, {.round = 1, .rounds_under_way = 2, .samples = {sample_with(11)}});
  CHECK(samples_in(lockstep->take_due(network.inbox, at(1))) == 0);
  network.send(1, {.round = 2, .samples = {sample_with(12)}});
  network.send(2, {.round = 2, .samples = {sample_with(22)}});
  const auto second = lockstep->take_due(network.inbox, at(2));
  REQUIRE(second.size() == 2);
  CHECK((second[0].from == 1 && second[0].bundle.samples.size() == 1));
  REQUIRE(second[1].bundle.samples.size() == 2);
  CHECK((second[1].bundle.samples[0].id == 22 && second[1].bundle.samples[1].id == 21));
  network.send(2, {.round = 3});
  CHECK_THROWS_AS(lockstep->take_due(network.inbox, at(3)), ProtocolError);  // rank 1 owed a bundle
}

TEST_CASE("exchange policy: a rank alone waits for nobody") {
  for (const ClockKind clock : {ClockKind::kWork, ClockKind::kWall}) {
    SessionSettings settings{.sampler = SamplerChoice::kAuto};
    settings.clock = clock;
    const auto alone = make_exchange_policy(settings, 1);
    Network network;
    CHECK_FALSE(alone->counts_bundles());
    CHECK(alone->missing(network.inbox, {.frame_index = 0, .begun_in = 0, .round = 1}) == 0);
    CHECK(alone->missing_seeds(network.inbox, {}, {}, 0) == 0);
  }
}

}  // namespace
}  // namespace pprt::exchange_policy_test
