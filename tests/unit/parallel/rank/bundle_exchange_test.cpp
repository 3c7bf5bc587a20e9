// What a rank sends in a round, to whom, and what of all that has come it takes when.
#include "parallel/rank/bundle_exchange.h"

#include <catch2/catch.hpp>
#include <vector>

#include "parallel/clock/make_clocks.h"
#include "parallel/network/local_communicator.h"
#include "unit/parallel/clock/set_clock.h"

namespace pprt::bundle_exchange_test {
namespace {

constexpr int kRanks = 3;

std::unique_ptr<ExchangePolicy> policy_of(ClockKind clock) {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.clock = clock;
  return make_exchange_policy(settings, kRanks);
}

// One rank's exchange, and what else has come to it.
struct End {
  End(LocalNetwork& network, int rank, ClockKind kind)
      : communicator(network, rank), exchange(communicator, inbox, policy_of(kind), clock, timer) {
    exchange.begin_frame(0);
    exchange.begin_picture(0);
    exchange.begin_round(1);
  }

  LocalCommunicator communicator;
  std::vector<Message> others;  // for the session
  int looks = 0;
  Inbox inbox{communicator, 0.01, [this](const Message& m) { others.push_back(m); }, [this] { ++looks; }};
  double now = 0;
  SetClock clock{1, 1, now};
  StageTimer timer{clock};
  BundleExchange exchange;
};

struct Ends {
  explicit Ends(ClockKind kind) : ends{{network, 0, kind}, {network, 1, kind}, {network, 2, kind}} {}
  LocalNetwork network{kRanks};
  End ends[kRanks];
  BundleExchange& operator[](int rank) { return ends[rank].exchange; }
};

BundleExchange::Content samples(std::size_t count) {
  return {.samples = std::vector<Sample>(count)};
}

BundleExchange::Content given(std::int32_t tile) {
  return {.tiles = {.given = {{.tile = tile, .owner = 0, .version = 1}}}};
}

}  // namespace

TEST_CASE("bundle exchange: what concerns a rank reaches it, and nothing else nor who was given up") {
  Ends ranks(ClockKind::kWall);
  ranks[1].send(0, true, samples(3));
  ranks[1].send(2, false, samples(4));
  ranks[2].give_up(0);
  ranks[2].send(0, true, samples(5));
  const std::vector<Inbox::Arrived> come = ranks[0].receive();
  REQUIRE(come.size() == 1);
  CHECK((come[0].from == 1 && come[0].bundle.samples.size() == 3));
  CHECK((come[0].bundle.frame_index == 0 && come[0].bundle.begun_in == 0 && come[0].bundle.round == 1));
  CHECK(ranks[2].receive().empty());
}

TEST_CASE("bundle exchange: bytes are counted by kind, in each frame anew") {
  Ends ranks(ClockKind::kWall);
  ranks[1].send(0, true, samples(0));
  const BundleBytes empty = ranks[1].bytes();
  CHECK((empty.samples == 0 && empty.tiles == 0 && empty.progress > 0));
  ranks[1].send(0, true, samples(3));
  const BundleBytes three = ranks[1].bytes();
  CHECK((three.samples == 3 * kSampleBytes && three.tiles == 0 && three.progress == 2 * empty.progress));
  ranks[1].send(0, true, given(4));
  CHECK((ranks[1].bytes().tiles > 0 && ranks[1].bytes().samples == three.samples));
  ranks[1].begin_frame(1);
  CHECK((ranks[1].bytes().samples == 0 && ranks[1].bytes().tiles == 0 && ranks[1].bytes().progress == 0));
}

TEST_CASE("bundle exchange: handshakes and transfers are read on receipt, but not of who was given up") {
  for (const bool is_given_up : {false, true}) {
    Ends ranks(ClockKind::kWall);
    if (is_given_up) ranks[0].give_up(1);
    ranks[0].handshake().transfer_sent(1);
    ranks[1].send(0, true, given(4));
    ranks[0].receive();
    CHECK(ranks[0].handshake().accepts(1) == !is_given_up);
    CHECK_FALSE(ranks[0].handshake().accepts(2));
    if (is_given_up) continue;
    ranks[0].send(1, true, {});
    ranks[1].handshake().transfer_sent(0);
    ranks[1].receive();
    CHECK(ranks[1].handshake().has_confirmed_transfers(0));  // rank 0 has told of the one that came
  }
}

TEST_CASE("bundle exchange: bundles are taken by frame and round") {
  Ends ranks(ClockKind::kWall);
  const auto send = [&](int frame, int round, std::int32_t tile) {
    ranks[1].begin_frame(frame);
    ranks[1].begin_round(round);
    ranks[1].send(0, true, given(tile));
  };
  send(0, 1, 10), send(1, 1, 11), send(2, 1, 12), send(2, 2, 13);
  ranks[0].begin_frame(2);
  CHECK(ranks[0].at().round == kSeedRound);
  ranks[0].begin_round(1);
  ranks[0].look();
  const auto tiles = [](const std::vector<Inbox::Arrived>& come) {
    std::vector<std::int32_t> result;
    for (const Inbox::Arrived& a : come) result.push_back(a.bundle.tiles.given.at(0).tile);
    return result;
  };
  const TileNews news = ranks[0].earlier_news();
  REQUIRE(news.given.size() == 2);
  CHECK((news.given[0].tile == 10 && news.given[1].tile == 11));
  CHECK(tiles(ranks[0].take_of_round()) == std::vector{12});
  CHECK(tiles(ranks[0].take_earlier()) == std::vector{10, 11});
  CHECK(ranks[0].earlier_news().given.empty());
  ranks[0].begin_round(2);
  CHECK(tiles(ranks[0].take_of_round()) == std::vector{13});
}

TEST_CASE("bundle exchange: in lockstep the master is told of each round whom it had bundles for") {
  for (const bool is_seeding : {true, false}) {
    Ends ranks(ClockKind::kWork);
    ranks[1].send(2, true, samples(1));
    ranks[1].send(0, true, samples(1));
    ranks.ends[0].communicator.send(1, Tag::kRoundDue, encode(RoundDue{.round = 1, .bundles = 0}));
    is_seeding ? ranks[1].await_seeds({}) : static_cast<void>(ranks[1].receive());
    ranks[0].look();
    REQUIRE(ranks.ends[0].others.size() == 1);
    const RoundSent told = decode_round_sent(ranks.ends[0].others[0].payload);
    CHECK((told.frame_index == 0 && told.round == 1 && told.receivers == std::vector<std::int32_t>{2, 0}));
    // The next round has its own.
    ranks[1].begin_round(2);
    ranks.ends[0].communicator.send(1, Tag::kRoundDue, encode(RoundDue{.round = 2, .bundles = 0}));
    ranks[1].receive();
    ranks[0].look();
    REQUIRE(ranks.ends[0].others.size() == 2);
    CHECK(decode_round_sent(ranks.ends[0].others[1].payload).receivers.empty());
  }
}

TEST_CASE("bundle exchange: messages are looked at after every 1024 rays") {
  Ends ranks(ClockKind::kWall);
  const auto looks_after = [&](std::uint64_t rays) {
    ranks[0].poll(rays);
    return ranks.ends[0].looks;
  };
  CHECK(looks_after(1000) == 0);
  CHECK(looks_after(23) == 0);
  CHECK(looks_after(1) == 1);
  CHECK(looks_after(1023) == 1);
  CHECK(looks_after(5000) == 2);
  CHECK(looks_after(1) == 2);
}

TEST_CASE("bundle exchange: on the wall clock the master is told of no round") {
  Ends ranks(ClockKind::kWall);
  ranks[1].send(2, true, samples(1));
  ranks[1].receive();
  ranks[0].look();
  CHECK(ranks.ends[0].others.empty());
}

}  // namespace pprt::bundle_exchange_test
