// One rank's tiles as they come and go: by its neighbours' word, by new partitions, and in frames left out.
#include "parallel/rank/tile_ownership.h"

#include <catch2/catch.hpp>

#include "unit/parallel/rank/one_rank.h"

namespace pprt::tile_ownership_test {
namespace {

using test::OneRank;

constexpr WorkUnits kLargeBudget = 24'000'000'000;  // in which anything is affordable

// Rank 1 of two has the right half: the tiles of the last two of four columns.
struct RightHalf : OneRank {
  explicit RightHalf(const SessionSettings& the_settings = settings_of({}), WorkUnits budget = 0)
      : OneRank(the_settings, 1, 2, budget),
        ownership(settings, 1, 2, sampling, costs, handshake, clock, timer) {
    is_wavy = true;
    tracer.begin_frame({});
    sampling.trace_seeds();
    ownership.begin_frame();
  }

  const Partition& known() const { return sampling.exchange().partition(); }
  int owner(std::size_t tile) const { return known().owner[tile]; }

  // So many of the 24 rounds of a frame with a rate pass.
  void pass(int rounds) {
    for (int round = 0; round < rounds; ++round) clock.begin_packet(0);
  }

  TransferHandshake handshake{2};
  StageTimer timer{clock};
  TileOwnership ownership;
};

SessionSettings with_rate() {
  SessionSettings settings = OneRank::settings_of({});
  settings.frames_per_second = 10;
  return settings;
}

TileTransfer given(std::int32_t tile, std::int32_t owner, std::uint64_t version) {
  return {
      .tile = tile, .owner = owner, .version = version, .now = {.cost = 10.0 + tile}, .last = {.cost = 20}};
}

TileNews news_of(std::vector<TileTransfer> tiles, std::vector<OwnerChange> changes = {}) {
  return {.given = std::move(tiles), .changes = std::move(changes)};
}

// An order with the partition of these owners.
FrameOrder order_with(const std::vector<std::int32_t>& owners, std::uint32_t generation = 3) {
  FrameOrder order;
  order.owners = owners, order.generation = generation;
  order.partition_bytes = 17;
  return order;
}

std::vector<std::int32_t> rows_of(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
  std::vector<std::int32_t> owners;
  for (int row = 0; row < 4; ++row) owners.insert(owners.end(), {a, b, c, d});
  return owners;
}

}  // namespace

TEST_CASE("tile ownership: a tile is whose the newest word says, and what it cost is taken over once") {
  RightHalf rank;
  rank.ownership.apply(news_of({given(1, 1, 5)}, {{4, 1, 2}, {0, 1, 0}}));
  CHECK((rank.owner(1) == 1 && rank.known().version[1] == 5));
  CHECK((rank.owner(4) == 1 && rank.known().version[4] == 2));
  CHECK(rank.owner(0) == 0);  // version 0 is what it has
  CHECK(rank.costs.now(1).cost == 11);
  CHECK(rank.costs.now(4).cost == 0);
  CHECK((rank.sampling.region().owns_tile(1) && rank.sampling.region().owns_tile(4)));
  rank.costs.accept({.tile = 1, .now = {.cost = 99}});
  rank.ownership.apply(news_of({given(1, 1, 5)}, {{1, 0, 4}}));  // the same again, and what was before it
  CHECK((rank.owner(1) == 1 && rank.costs.now(1).cost == 99));
  rank.ownership.apply(news_of({}, {{1, 0, 6}}));
  CHECK((rank.owner(1) == 0 && !rank.sampling.region().owns_tile(1)));
}

TEST_CASE("tile ownership: a tile that has been given on by now is no gain") {
  RightHalf rank;
  rank.ownership.apply(news_of({given(1, 1, 5)}, {{1, 0, 6}}));
  CHECK(rank.owner(1) == 0);
  CHECK(rank.sampling.take_outbox(0).empty());
  rank.ownership.forward_lost_tiles(std::vector{given(1, 1, 5), given(2, 1, 1), given(4, 0, 1)});
  for (const Sample& sample : rank.sampling.take_outbox(0)) CHECK(sample.x <= 32);
}

TEST_CASE("tile ownership: tiles or ranks that there are not are refused") {
  for (const auto& [tile, owner] : {std::pair(16, 0), {-1, 0}, {0, 2}, {0, -1}}) {
    RightHalf rank;
    INFO("tile " << tile << " to " << owner);
    CHECK_THROWS_AS(rank.ownership.apply(news_of({}, {{tile, owner, 9}})), ProtocolError);
    CHECK_THROWS_AS(rank.ownership.apply(news_of({given(tile, owner, 9)})), ProtocolError);
  }
}

TEST_CASE("tile ownership: where most samples were cast tiles go in the first quarter of a frame alone") {
  const auto gives = [](int rounds, bool is_cast, BalanceMode mode, bool fresh = true) {
    SessionSettings settings = with_rate();
    settings.sampler.choice() = SamplerChoice::kDelaunay, settings.balance = mode;
    RightHalf rank(settings, kLargeBudget);
    FrameOrder order;
    order.number = 5;
    rank.tracer.begin_frame(order);
    if (is_cast) {
      std::vector<Sample> samples;
      for (int i = 0; i < 2000; ++i) {
        Sample& sample = samples.emplace_back();
        sample.x = 32.3 + i % 50 * 0.6, sample.y = 0.7 + i / 50 * 1.5, sample.frame = 4;
      }
      rank.sampling.reinsert_all(samples);
    }
    for (int i = 0; i < 600; ++i) rank.sampling.refine(nullptr);
    rank.clock.begin_frame(order);
    rank.pass(rounds);
    rank.ownership.progress();
    rank.handshake.receive(0, {});
    rank.ownership.receive_progress(
        0, {.mean_weight = 1e-9, .target_weight = 1e-3, .future_cost = 0, .pace = 1});
    return !rank.ownership.give_tiles(fresh, 7).empty();
  };
  for (const BalanceMode mode : {BalanceMode::kLocal, BalanceMode::kCombined}) {
    CHECK(gives(6, false, mode));
    CHECK(gives(12, false, mode));
  }
  CHECK(gives(6, true, BalanceMode::kLocal));
  CHECK_FALSE(gives(7, true, BalanceMode::kLocal));
  CHECK_FALSE(gives(6, true, BalanceMode::kCombined));
  CHECK_FALSE(gives(20, false, BalanceMode::kLocal));       // late
  CHECK_FALSE(gives(6, true, BalanceMode::kLocal, false));  // at rest, with more samples than pixels
  CHECK_FALSE(gives(6, false, BalanceMode::kGlobal));
}

TEST_CASE("tile ownership: gains are told once, late in a frame with a rate, of what is still there") {
  RightHalf rank(with_rate(), kLargeBudget);
  rank.clock.begin_frame({});
  rank.pass(21);
  rank.ownership.apply(news_of({given(0, 1, 5), given(1, 1, 6)}));
  rank.ownership.apply(news_of({}, {{0, 0, 7}}));
  CHECK(rank.ownership.take_gains().empty());
  rank.pass(1);  // nine tenths have passed
  const std::vector<OwnerChange> gains = rank.ownership.take_gains();
  REQUIRE(gains.size() == 1);
  CHECK((gains[0].tile == 1 && gains[0].owner == 1 && gains[0].version == 6));
  CHECK(rank.ownership.take_gains().empty());
  RightHalf without;
  without.ownership.apply(news_of({given(1, 1, 6)}));
  CHECK(without.ownership.take_gains().empty());
}

TEST_CASE("tile ownership: a new partition has versions of its own, and tells what new tiles were") {
  RightHalf rank;
  FrameOrder order = order_with(rows_of(1, 0, 1, 0));
  for (int i = 0; i < 8; ++i) order.tiles.push_back({.cost = 100.0 + i, .average_weight = 2});
  rank.ownership.repartition(order, false);
  CHECK(rank.known().owner == order.owners);
  for (const std::uint64_t version : rank.known().version) CHECK(version == std::uint64_t{3} << 32);
  // Own tiles are 0, 2, 4, 6 and so on; those of the first column are new.
  for (int row = 0; row < 4; ++row) {
    CHECK(rank.costs.last(4 * row).cost == 100 + 2 * row);
    CHECK(rank.costs.last(4 * row + 2).cost == 0);  // it knows better itself
    CHECK(rank.costs.last(4 * row + 1).cost == 0);
  }
  CHECK(rank.ownership.partition_bytes() == 17);
  rank.ownership.begin_frame();
  CHECK(rank.ownership.partition_bytes() == 0);
  CHECK_THROWS_AS(rank.ownership.repartition(order_with({0, 1}), false), ProtocolError);
}

TEST_CASE("tile ownership: with a new partition go the samples of tiles that go, if they are to be kept") {
  for (const bool keeps : {true, false}) {
    RightHalf rank;
    for (int i = 0; i < 200; ++i) rank.sampling.refine(nullptr);
    rank.sampling.announce();
    rank.sampling.take_outbox(0);
    rank.ownership.repartition(order_with(rows_of(0, 0, 1, 0)), keeps);
    const std::vector<Sample> sent = rank.sampling.take_outbox(0);
    CHECK(sent.empty() != keeps);
    for (const Sample& sample : sent) CHECK(sample.x >= 44);  // centres reach four pixels beyond a tile
    if (!keeps) continue;
    std::size_t of_column = 0;
    for (const Sample& sample : rank.sampling.sampler().samples()) of_column += sample.x >= 48;
    CHECK(sent.size() >= of_column);
  }
}

TEST_CASE("tile ownership: where a partition drops samples nothing is carried into its frame") {
  for (const bool keeps : {true, false}) {
    SessionSettings settings = OneRank::settings_of({});
    settings.keep_samples = keeps;
    const RightHalf rank(settings);
    FrameOrder order;
    order.carry = Carry::kAccumulate;
    CHECK(rank.ownership.carry_into(order) == Carry::kAccumulate);
    order.owners = rows_of(0, 0, 1, 1);
    CHECK(rank.ownership.carry_into(order) == (keeps ? Carry::kAccumulate : Carry::kNothing));
  }
}

TEST_CASE("tile ownership: of frames left out counts the last picture, and any cut") {
  RightHalf rank;
  const auto leave_out = [&](int index, Carry carry) {
    FrameOrder order;
    order.index = index, order.carry = carry;
    rank.ownership.leave_out(order);
  };
  leave_out(4, Carry::kAccumulate);
  CHECK_FALSE(rank.ownership.take_missed().picture);
  leave_out(5, Carry::kCastWherePaying);
  leave_out(6, Carry::kAccumulate);
  MissedFrames missed = rank.ownership.take_missed();
  CHECK((missed.picture && missed.begun_in == 5 && !missed.cut));
  CHECK_FALSE(rank.ownership.take_missed().picture);
  leave_out(7, Carry::kNothing);
  leave_out(8, Carry::kCastPaper);
  missed = rank.ownership.take_missed();
  CHECK((missed.picture && missed.begun_in == 8 && missed.cut));
  FrameOrder order = order_with(rows_of(0, 1, 1, 1));
  order.carry = Carry::kAccumulate;
  rank.ownership.leave_out(order);
  CHECK(rank.known().owner == order.owners);  // whose the tiles are holds all the same
}

TEST_CASE("tile ownership: progress is told where tiles may change hands, and by nobody alone") {
  for (const BalanceMode mode :
       {BalanceMode::kNone, BalanceMode::kLocal, BalanceMode::kGlobal, BalanceMode::kCombined}) {
    SessionSettings settings = OneRank::settings_of({});
    settings.balance = mode;
    RightHalf rank(settings);
    for (int i = 0; i < 200; ++i) rank.sampling.refine(nullptr);
    const bool is_local = mode == BalanceMode::kLocal || mode == BalanceMode::kCombined;
    CHECK(rank.ownership.balances_locally() == is_local);
    CHECK((rank.ownership.progress().mean_weight > 0) == is_local);
  }
}

TEST_CASE("tile ownership: tiles are given to a neighbour that is ahead, and are its own at once") {
  SessionSettings settings = OneRank::settings_of({}, SamplerChoice::kDelaunay);
  settings.balance = BalanceMode::kLocal, settings.report_transfers = true;
  const auto ready = [](RightHalf& rank) {
    for (int i = 0; i < 600; ++i) rank.sampling.refine(nullptr);
    rank.ownership.progress();  // learns what tiles cost
    rank.handshake.receive(0, {});
    rank.ownership.receive_progress(
        0, {.mean_weight = 1e-9, .target_weight = 1e-3, .future_cost = 0, .pace = 1});
    return rank.ownership.give_tiles(true, 7);
  };
  RightHalf rank(settings);
  const std::vector<TileTransfer> transfers = ready(rank);
  REQUIRE_FALSE(transfers.empty());
  CHECK(transfers.size() <= 2);  // a quarter of eight
  std::vector<std::int32_t> tiles;
  for (const TileTransfer& transfer : transfers) {
    tiles.push_back(transfer.tile);
    CHECK((transfer.tile % 4 == 2 && transfer.owner == 0 && transfer.version == 1));
    CHECK(rank.owner(static_cast<std::size_t>(transfer.tile)) == 0);
  }
  CHECK(rank.ownership.given() == tiles);
  CHECK_FALSE(rank.sampling.take_outbox(0).empty());
  CHECK_FALSE(rank.handshake.has_confirmed_transfers(0));
  const std::vector<TransferChoice> choices = rank.ownership.take_choices();
  REQUIRE(choices.size() == 1);
  CHECK((choices[0].giver == 1 && choices[0].round == 7 && choices[0].given.size() == tiles.size()));
  CHECK((choices[0].given[0] == GivenTile{tiles[0], 0}));
  CHECK(rank.ownership.take_choices().empty());
  rank.ownership.begin_frame();
  CHECK(rank.ownership.given().empty());
  // Where a number of samples is the goal each rank takes the share of its area.
  SessionSettings counted = settings;
  counted.stop.samples = 5000;
  RightHalf same(counted);
  CHECK(ready(same).empty());
  // A lattice balances with a rate only.
  SessionSettings lattice = settings;
  lattice.sampler.choice() = SamplerChoice::kAuto;
  RightHalf still(lattice);
  CHECK(ready(still).empty());
  SessionSettings silent = settings;
  silent.report_transfers = false;
  RightHalf unreported(silent);
  CHECK_FALSE(ready(unreported).empty());
  CHECK(unreported.ownership.take_choices().empty());
}

}  // namespace pprt::tile_ownership_test
