// What a rank makes of its neighbours' reports, and the numbers that local balancing goes by.
#include "parallel/balance/balancer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "parallel/balance/global_balance.h"
#include "parallel/exchange/samplers.h"
#include "unit/parallel/balance/halves.h"

namespace pprt::balancer_test {
namespace {

constexpr double kUnlimited = 1e18;
constexpr double kRays = 50;  // of each sample: what pixels cost is little beside them

// Rank 0's side: one sample in each of its tiles, and weights of mean 4.
struct Side {
  Partition partition = test::halves();
  Region own = region_of(partition, 0);
  std::vector<TileWeights> weights = std::vector<TileWeights>(32);
  CostEstimator costs{partition.grid, work_of(traits_of(SamplerChoice::kDelaunay))};
  TransferHandshake handshake{2};
  std::vector<int> beside = {1};
  Balancer balancer{0, 2, costs};

  explicit Side(FrameLikeness likeness = FrameLikeness::kUnknown) {
    costs.begin_frame(true, likeness);
    for (const int tile : own.tiles()) {
      const PixelRect rect = partition.grid.pixels(tile);
      Sample sample;
      sample.x = rect.x0 + 5, sample.y = rect.y0 + 5, sample.ray.rays = static_cast<std::uint32_t>(kRays);
      costs.add_own(sample);
      weights[static_cast<std::size_t>(tile)] = {.total_weight = 4, .count = 1};
    }
    costs.update(quality(), 0.5);
    balancer.begin_frame(1);
    handshake.receive(1, {});
    handshake.set_giving(true);
  }

  RegionQuality quality() const { return {own, weights, 4}; }
  std::vector<TileTransfer> transfers(double elapsed = 1, double most_samples = kUnlimited) const {
    const KnownRanks others{partition, beside,
                            [](int rank) { return std::vector<std::uint32_t>(32, rank == 0 ? 10 : 0); }};
    return balancer.choose_transfers(quality(), others, handshake, elapsed, most_samples);
  }
};

constexpr RankProgress kAhead{.mean_weight = 1, .target_weight = 0.5, .future_cost = 0, .pace = 1};

}  // namespace

TEST_CASE("balancer: the noise is the reciprocal root of the triangles there will be, a tenth at the start") {
  for (const auto& [triangles, elapsed, noise] : {std::tuple(100, 1.0, 0.1),
                                                  {100, 0.0, std::sqrt(0.001)},
                                                  {400, 0.5, std::sqrt(0.55 / 400)},
                                                  {0, 1.0, 1.0}}) {
    CHECK(relative_noise(std::int64_t{triangles}, elapsed) == Approx(noise));
  }
  const Side side;
  CHECK(relative_noise(side.quality(), 1) == Approx(std::sqrt(1.0 / 16)));  // of sixteen tiles
}

TEST_CASE("balancer: a rank's progress names the power of two at or below what the frame will end at") {
  Side side;
  for (const auto& [elapsed, target] : {std::pair(1.0, 4.0), {0.9, 2.0}, {0.5, 2.0}, {0.2, 0.5}}) {
    const RankProgress progress = side.balancer.progress(side.quality(), elapsed);
    CHECK((progress.mean_weight == 4 && progress.target_weight == target && progress.pace == 1));
    CHECK(progress.future_cost == Approx(side.costs.future_cost_of_region(side.quality(), target)));
  }
  const RankProgress nothing = side.balancer.progress({side.own, side.weights, 0}, 1);
  CHECK((nothing.mean_weight == 0 && nothing.target_weight == 0 && nothing.future_cost == 0));
}

TEST_CASE("balancer: tiles change hands in the first half of a frame, or three quarters of an unknown one") {
  const auto is_early = [](FrameLikeness likeness, double elapsed) {
    return Side(likeness).balancer.is_early_enough(elapsed);
  };
  for (const FrameLikeness known : {FrameLikeness::kSimilar, FrameLikeness::kSame})
    CHECK((is_early(known, 0.5) && !is_early(known, 0.51)));
  CHECK((is_early(FrameLikeness::kUnknown, 0.75) && !is_early(FrameLikeness::kUnknown, 0.76)));
}

TEST_CASE("balancer: of a frame that begins nothing is known of the neighbours") {
  Side side;
  CHECK_FALSE(side.balancer.wants_to_give(side.quality(), side.beside, 1, false));
  CHECK(side.transfers().empty());
  side.balancer.receive(1, kAhead);
  CHECK(side.balancer.wants_to_give(side.quality(), side.beside, 1, false));
  CHECK_FALSE(side.balancer.wants_to_give(side.quality(), {}, 1, false));
  CHECK_FALSE(side.transfers().empty());
  side.balancer.begin_frame(1);
  CHECK_FALSE(side.balancer.wants_to_give(side.quality(), side.beside, 1, false));
  CHECK(side.transfers().empty());
}

TEST_CASE("balancer: nothing is given but to who accepts, and has told that earlier tiles have come") {
  Side side;
  side.balancer.receive(1, kAhead);
  REQUIRE_FALSE(side.transfers().empty());
  side.handshake.transfer_sent(1);
  CHECK(side.transfers().empty());
  side.handshake.receive(1, {.phase = 0, .acknowledged = 0, .transfers_received = 1});
  CHECK_FALSE(side.transfers().empty());
  side.handshake.receive(1, {.phase = 1, .acknowledged = 0, .transfers_received = 1});  // gives itself
  CHECK(side.transfers().empty());
  side.handshake.receive(1, {.phase = 2, .acknowledged = 0, .transfers_received = 1});
  CHECK_FALSE(side.transfers().empty());
  side.handshake.set_giving(false);
  CHECK(side.transfers().empty());
}

TEST_CASE("balancer: a transfer has the next version of its tile, and what the tile has cost") {
  Side side;
  side.balancer.receive(1, kAhead);
  for (std::size_t tile = 0; tile < 32; ++tile) side.partition.version[tile] = 100 * tile;
  for (const int tile : side.own.tiles())
    side.costs.accept({.tile = tile, .now = {.cost = 6000.0 + tile}, .last = {.cost = 9.0 + tile}});
  side.costs.update(side.quality(), 0.5);
  const std::vector<TileTransfer> transfers = side.transfers();
  CHECK(transfers.size() == 4);
  for (const TileTransfer& t : transfers) {
    INFO("tile " << t.tile);
    CHECK((side.own.owns_tile(t.tile) && t.owner == 1));
    CHECK(t.version == 100 * static_cast<std::uint64_t>(t.tile) + 1);
    CHECK((t.now.cost == 6000 + t.tile && t.last.cost == 9 + t.tile));
  }
}

TEST_CASE("balancer: a neighbour takes in no more samples than it may") {
  Side side;
  side.balancer.receive(1, kAhead);
  CHECK(side.transfers().size() == 4);  // a quarter of the region
  CHECK(side.transfers(1, 25).size() == 2);
  CHECK(side.transfers(1, 9).empty());
}

TEST_CASE("balancer: of few triangles little is certain, and less at the frame's end") {
  Side side;
  side.balancer.receive(1, kAhead);
  const double own = side.costs.future_cost_of_region(side.quality(), kAhead.target_weight);
  RankProgress close = kAhead;
  close.future_cost = own / 3;  // beyond 14 times the noise, 1.5, and within it, 3.5
  side.balancer.receive(1, close);
  CHECK_FALSE(side.transfers(0.1).empty());
  CHECK(side.transfers(1).empty());
  CHECK(side.balancer.wants_to_give(side.quality(), side.beside, 1, false));
  close.future_cost = own / 1.5;  // 3.5 times the noise are .38 and .88
  side.balancer.receive(1, close);
  CHECK(side.balancer.wants_to_give(side.quality(), side.beside, 0.1, false));
  CHECK_FALSE(side.balancer.wants_to_give(side.quality(), side.beside, 1, false));
  CHECK(side.balancer.wants_to_give(side.quality(), side.beside, 1, true));
}

TEST_CASE("local balancing: a tile costlier than half as much again as what is to move stays") {
  const auto given = [](double cost) {
    const auto offer = [cost](int) { return TileOffer{cost, 10, 0}; };
    return tiles_to_give({}, test::halves(), 0, 1, {1000, 1, kUnlimited}, offer).size();  // 300 are to move
  };
  CHECK(given(449) == 1);
  CHECK(given(451) == 0);
}

TEST_CASE("local balancing: grades are the paper's three terms and the shape, by their weights") {
  // Two tiles of the border that differ in one term each; the one with the better grade goes.
  struct Case {
    const char* why;
    TileOffer first, second;
    std::vector<int> given;
  };
  constexpr TileOffer kTooMany{100, 1e6, 0};  // samples for the taker
  constexpr int kFirst = 3, kSecond = 27;     // the border's ends, alike in shape and border
  for (const auto& [why, first, second, given] :
       {Case{"what it takes away", {100, 10, 0}, {90, 10, 0}, {kFirst}},
        Case{"what it takes away", {90, 10, 0}, {100, 10, 0}, {kSecond}},
        Case{"what it costs the taker", {100, 60, 0}, {100, 10, 0}, {kSecond}},
        Case{"what the taker knows", {100, 10, 5}, {100, 10, 0}, {kFirst}},
        Case{"a share known against a share of the relief", {100, 10, 0}, {90, 10, 6}, {kSecond}},
        Case{"a share known against a share of the relief", {100, 10, 0}, {80, 10, 6}, {kFirst}}}) {
    const auto offer = [first = first, second = second](int tile) {
      return tile == kFirst ? first : tile == kSecond ? second : kTooMany;
    };
    const LocalBalanceSettings alike{.shape_weight = 0};
    INFO(why);
    CHECK(tiles_to_give(alike, test::halves(), 0, 1, {330, 0.5, 1e5}, offer) == given);
  }
}

TEST_CASE(
    "local balancing: where nothing else differs, the tile goes that is nearest to the taker's middle") {
  // The taker's tiles lie around one end of the border.
  for (const bool is_top : {true, false}) {
    Partition partition = test::halves();
    for (int tile = 0; tile < 32; ++tile) {
      const int row = tile / 8;
      if (tile % 8 > 4 && (is_top ? row > 1 : row < 2)) partition.owner[static_cast<std::size_t>(tile)] = 2;
    }
    partition.ranks = 3;
    LocalBalanceSettings settings;
    settings.border_weight = 0;
    const auto offer = [](int) { return TileOffer{100, 10, 0}; };
    const std::vector<int> tiles = tiles_to_give(settings, partition, 0, 1, {330, 1, kUnlimited}, offer);
    REQUIRE(tiles.size() == 1);
    CHECK(tiles[0] / 8 == (is_top ? 0 : 3));
  }
}

TEST_CASE("local balancing: any tile of a region may go, the first and the last of the picture, too") {
  // 2 x 4 tiles, a column each; one tile of the giver's costs something. A quarter of its tiles may go.
  for (const int giver : {0, 1}) {
    const Partition partition{
        TileGrid(20, 40, 10), 2, {0, 1, 0, 1, 0, 1, 0, 1}, std::vector<std::uint64_t>(8, 0)};
    for (const int dear : {giver, giver + 6}) {
      const auto offer = [&](int tile) { return TileOffer{tile == dear ? 100.0 : 0.0, 10, 0}; };
      INFO("tile " << dear);
      const std::vector<int> given = tiles_to_give({}, partition, giver, 1 - giver, {1000, 1, 1e18}, offer);
      CHECK(given == std::vector{dear});
    }
  }
}

TEST_CASE("partition: neighbours touch at a side or a corner, not across the picture's edge") {
  // 3 x 3 tiles, each its own rank's.
  Partition partition{TileGrid(30, 30, 10), 9, {0, 1, 2, 3, 4, 5, 6, 7, 8}, std::vector<std::uint64_t>(9, 0)};
  const std::vector<std::vector<int>> expected = {{1, 3, 4},       {0, 2, 3, 4, 5},          {1, 4, 5},
                                                  {0, 1, 4, 6, 7}, {0, 1, 2, 3, 5, 6, 7, 8}, {1, 2, 4, 7, 8},
                                                  {3, 4, 7},       {3, 4, 5, 6, 8},          {4, 5, 7}};
  for (int rank = 0; rank < 9; ++rank)
    CHECK(ranks_beside(partition, rank) == expected[static_cast<std::size_t>(rank)]);
  CHECK(tiles_beside(partition.grid, 4) == std::vector{3, 5, 1, 7});
  CHECK(tiles_beside(partition.grid, 0) == std::vector{1, 3});
  CHECK(tiles_beside(partition.grid, 5) == std::vector{4, 2, 8});
  CHECK(tiles_beside(partition.grid, 6) == std::vector{7, 3});
}

TEST_CASE("partition: a tile's side is a multiple of what the sampler asks for, within its bounds") {
  for (const int multiple : {1, 8}) {
    for (const auto& [side, ranks] :
         {std::pair(100, 1), {300, 1}, {512, 1}, {512, 4}, {1024, 64}, {4096, 2}}) {
      const int size = tile_grid_for(side, side, ranks, multiple).tile_size;
      INFO(side << " on " << ranks << ", multiples of " << multiple << ": " << size);
      CHECK(size % multiple == 0);
      CHECK((size >= std::max(multiple, 2) && size <= 32));
      const double wanted = std::sqrt(static_cast<double>(side) * side / (100.0 * ranks));
      if (wanted <= 32 && wanted >= std::max(multiple, 2))
        CHECK((size <= wanted && size > wanted - multiple - 1));
    }
  }
}

TEST_CASE("partition: a cut runs across the longer side, where each side has its share") {
  // 6 x 2 tiles on two ranks of unlike speed, and the same on its side.
  for (const bool is_wide : {true, false}) {
    const TileGrid grid = is_wide ? TileGrid(60, 20, 10) : TileGrid(20, 60, 10);
    const std::vector<double> even(12, 1.0);
    for (const auto& [first, second, lines] : {std::tuple(1.0, 1.0, 3), {1.0, 2.0, 2}, {5.0, 1.0, 5}}) {
      const Partition partition = bisect(grid, even, std::vector{first, second});
      for (int tile = 0; tile < 12; ++tile) {
        const int line = is_wide ? tile % 6 : tile / 2;
        CHECK(partition.owner[static_cast<std::size_t>(tile)] == (line < lines ? 0 : 1));
      }
    }
  }
}

TEST_CASE("global balancing: a partition that is dropped leaves the generation as it was") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.balance = BalanceMode::kGlobal;
  GlobalBalancer balancer(settings, traits_of(settings.sampler), TileGrid(40, 10, 10), 2, 0);
  const auto order_after = [&](bool accumulates, Carry carry) {
    FrameReports frame{.accumulates = accumulates, .tiles = {{}, {}}, .speeds = {1, 1}};
    for (int tile = 0; tile < 4; ++tile)
      frame.tiles[tile < 2 ? 0 : 1].push_back(
          {.tile = tile, .triangles = 10, .total_weight = 10, .cost = 100});
    balancer.consider(frame);
    FrameOrder order;
    order.carry = carry;
    balancer.add_partition(order);
    return order;
  };
  CHECK(order_after(false, Carry::kNothing).generation == 1);
  const FrameOrder dropped = order_after(true, Carry::kNothing);  // from many frames, for a new picture
  CHECK((dropped.owners.empty() && dropped.columns == 0 && dropped.generation == 1));
  const FrameOrder next = order_after(false, Carry::kNothing);
  CHECK((next.owners.size() == 4 && next.columns == 4 && next.generation == 2));
}

TEST_CASE("global balancing: a rank lost before any report leaves its share to the others, all alike") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.balance = BalanceMode::kNone;
  GlobalBalancer balancer(settings, traits_of(settings.sampler), TileGrid(60, 10, 10), 3, 0);
  constexpr std::int32_t kLost = 1;
  balancer.take_over({&kLost, 1});
  FrameOrder order;
  balancer.add_partition(order);
  CHECK(order.owners == std::vector<std::int32_t>{0, 0, 0, 2, 2, 2});
}

TEST_CASE("global balancing: tiles of a lost rank go by the last whole report, not by a torn one") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.balance = BalanceMode::kNone;
  GlobalBalancer balancer(settings, traits_of(settings.sampler), TileGrid(60, 10, 10), 3, 0);
  FrameReports whole{.tiles = {{}, {}, {}}, .speeds = {1, 1, 1}};
  for (int tile = 0; tile < 6; ++tile)
    whole.tiles[0].push_back(
        {.tile = tile, .triangles = 10, .total_weight = 10, .cost = tile == 0 ? 1e6 : 100.0});
  balancer.consider(whole);
  FrameReports torn{.is_whole = false, .tiles = {{}, {}, {}}, .speeds = {1, 1, 1}};
  balancer.consider(torn);
  constexpr std::int32_t kLost = 1;
  balancer.take_over({&kLost, 1});
  FrameOrder order;
  balancer.add_partition(order);
  CHECK(order.owners == std::vector<std::int32_t>{0, 2, 2, 2, 2, 2});  // the first costs more than all others
}

}  // namespace pprt::balancer_test
