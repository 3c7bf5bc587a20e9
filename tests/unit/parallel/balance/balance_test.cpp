#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "parallel/balance/balancer.h"
#include "parallel/balance/global_balance.h"
#include "parallel/balance/local_balance.h"
#include "parallel/balance/transfer_handshake.h"
#include "parallel/exchange/samplers.h"
#include "unit/each_sampler.h"
#include "unit/parallel/balance/halves.h"
#include "unit/parallel/exchange/exchange_ranks.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::balance_test {
namespace {

constexpr double kUnlimited = 1e18;

TileReport report(int tile, double cost, int triangles, double total_weight) {
  return {.tile = tile, .triangles = triangles, .total_weight = total_weight, .cost = cost};
}

// What two ranks report, two tiles each. The mean weight of rank 0's triangles is `first`, that of rank
// 1's 1.
FrameReports reports_of_two(int triangles, double first) {
  const auto of_rank = [&](int tile, double mean) {
    return std::vector{report(tile, 100, triangles, mean * triangles),
                       report(tile + 1, 100, triangles, mean * triangles)};
  };
  return {.tiles = {of_rank(0, first), of_rank(2, 1)}, .speeds = {1, 1}};
}

GlobalBalancer balancer_of_two(const SessionSettings& settings) {
  return GlobalBalancer(settings, traits_of(settings.sampler), TileGrid(40, 10, 10), 2, 0);
}

// Whether the order after this frame has a new partition.
bool repartitions(GlobalBalancer& balancer, const FrameReports& frame, Carry next = Carry::kNothing) {
  balancer.consider(frame);
  FrameOrder order;
  order.carry = next;
  balancer.add_partition(order);
  return !order.owners.empty();
}

SessionSettings without_carrying(SamplerChoice sampler, BalanceMode mode) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 128, settings.height = 96;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 25;
  settings.budget_units = default_budget_units(25);
  settings.cast = CastChoice::kOff;
  settings.balance = mode;
  return settings;
}

}  // namespace

TEST_CASE("local balancing: a rank gives only when it is behind in quality and in cost") {
  LocalBalanceSettings settings;
  settings.weight_ratio = settings.cost_ratio = 1.1;
  settings.cost_noise = 2;
  CHECK(should_give(settings, 2.0, 200, 0, {1.0, 0.5, 100}));
  CHECK_FALSE(should_give(settings, 1.05, 200, 0, {1.0, 0.5, 100}));
  CHECK_FALSE(should_give(settings, 2.0, 105, 0, {1.0, 0.5, 100}));
  CHECK(should_give(settings, 2.0, 200, 0.4, {1.0, 0.5, 100}));
  CHECK_FALSE(should_give(settings, 2.0, 200, 0.5, {1.0, 0.5, 100}));
  CHECK_FALSE(should_give(settings, 2.0, 200, 0, {}));  // no progress was received
}

TEST_CASE("local balancing: target qualities are powers of two, at most the quality") {
  CHECK(target_weight_for(1.0) == 1.0);
  CHECK(target_weight_for(0.9) == 0.5);
  CHECK(target_weight_for(3.0) == 2.0);
}

TEST_CASE(
    "local balancing: a share of the difference moves, along the border, and the giver stays connected") {
  const Partition partition = test::halves();
  const auto offer = [](int) { return TileOffer{100, 10, 0}; };
  const std::vector<int> tiles =
      tiles_to_give({}, partition, 0, 1, {1000, 1, kUnlimited}, offer);  // three tenths: three tiles
  CHECK(tiles.size() == 3);
  Partition after = partition;
  for (const int tile : tiles) {
    CHECK(partition.owner[static_cast<std::size_t>(tile)] == 0);
    after.owner[static_cast<std::size_t>(tile)] = 1;
  }
  CHECK(is_connected(after, 0));
  CHECK(is_connected(after, 1));
}

TEST_CASE(
    "local balancing: a transfer is bounded by what is left to move, the taker's room and a quarter of the "
    "region") {
  const Partition partition = test::halves();
  const auto costly = [](int) { return TileOffer{1000, 10, 0}; };
  CHECK(tiles_to_give({}, partition, 0, 1, {1200, 1, kUnlimited}, costly).empty());
  const auto plain = [](int) { return TileOffer{100, 10, 0}; };
  CHECK(tiles_to_give({}, partition, 0, 1, {1200, 1, 25}, plain).size() == 2);
  const auto known = [](int) { return TileOffer{100, 10, 10}; };
  CHECK(tiles_to_give({}, partition, 0, 1, {1000, 1, 0}, known).size() == 3);  // nothing to take in
  CHECK(tiles_to_give({}, partition, 0, 1, {1e9, 1, kUnlimited}, plain).size() == 4);
}

TEST_CASE("local balancing: a tile that costs the taker more than it relieves the giver comes last") {
  const auto offer = [](int tile) { return tile == 19 ? TileOffer{100, 1, 0} : TileOffer{100, 1000, 0}; };
  const std::vector<int> tiles = tiles_to_give({}, test::halves(), 0, 1, {400, 1, kUnlimited}, offer);
  REQUIRE(tiles.size() == 1);
  CHECK(tiles[0] == 19);
}

TEST_CASE("local balancing: tiles without cost are given on the way to those that have one") {
  // Only the column behind the border costs anything.
  const auto offer = [](int tile) { return tile % 8 == 2 ? TileOffer{1000, 10, 0} : TileOffer{0, 0, 0}; };
  CHECK_FALSE(tiles_to_give({}, test::halves(), 0, 1, {4000, 1, kUnlimited}, offer).empty());
}

TEST_CASE("local balancing: where nothing else differs, the tile goes that shortens the border most") {
  Partition partition = test::halves();
  constexpr int kSpur = 12;  // its other three sides are the taker's
  partition.owner[kSpur] = 0;
  const LocalBalanceSettings settings{.communication_weight = 0, .shape_weight = 0};
  const auto offer = [](int) { return TileOffer{100, 10, 0}; };
  CHECK(tiles_to_give(settings, partition, 0, 1, {400, 1, kUnlimited}, offer) == std::vector{kSpur});
}

TEST_CASE("local balancing: tiles that the taker knows go first") {
  const auto offer = [](int tile) { return TileOffer{100, 10, tile == 19 ? 10.0 : 0.0}; };
  const std::vector<int> tiles = tiles_to_give({}, test::halves(), 0, 1, {400, 1, kUnlimited}, offer);
  REQUIRE(tiles.size() == 1);
  CHECK(tiles[0] == 19);
}

// The eight tiles around one, in every pattern. The giver has others elsewhere, so that nothing else connects
// them.
TEST_CASE("local balancing: a tile goes if those of its giver around it hang together by their sides") {
  const TileGrid grid(80, 50, 10);
  constexpr int kMiddle = 2 * 8 + 2;
  constexpr std::array<std::size_t, 8> kAround = {9, 10, 11, 17, 19, 25, 26, 27};
  const auto offer = [](int tile) { return TileOffer{tile == kMiddle ? 100.0 : 1e9, 10, 0}; };
  int kept = 0;
  for (unsigned pattern = 0; pattern < 256; ++pattern) {
    Partition partition{grid, 2, std::vector<std::int32_t>(40, 1), std::vector<std::uint64_t>(40, 0)};
    for (const int tile : {6, 7, 14, 15, kMiddle}) partition.owner[static_cast<std::size_t>(tile)] = 0;
    for (std::size_t place = 0; place < kAround.size(); ++place)
      if ((pattern >> place & 1U) != 0) partition.owner[kAround[place]] = 0;
    const std::vector<int> sides = tiles_beside(grid, kMiddle);
    const auto is_givers = [&](int tile) { return partition.owner[static_cast<std::size_t>(tile)] == 0; };
    if (std::all_of(sides.begin(), sides.end(), is_givers)) continue;  // not beside the taker
    const std::vector<int> tiles = tiles_to_give({}, partition, 0, 1, {1000, 1, kUnlimited}, offer);
    // Spreads from one side over what is around: the others must be reached.
    std::set<int> reached;
    const auto first = std::find_if(sides.begin(), sides.end(), is_givers);
    std::vector<int> next(first, first == sides.end() ? first : first + 1);
    while (!next.empty()) {
      const int tile = next.back();
      next.pop_back();
      if (tile == kMiddle || !is_givers(tile) || !reached.insert(tile).second) continue;
      for (const int beside : tiles_beside(grid, tile)) next.push_back(beside);
    }
    const bool is_whole = std::all_of(sides.begin(), sides.end(),
                                      [&](int tile) { return !is_givers(tile) || reached.count(tile) != 0; });
    INFO("pattern " << pattern);
    CHECK(tiles == (is_whole ? std::vector{kMiddle} : std::vector<int>()));
    kept += is_whole ? 0 : 1;
  }
  CHECK(kept > 50);
}

TEST_CASE("local balancing: a tile of a ring goes, for what is beside it hangs together the long way round") {
  Partition partition{TileGrid(50, 50, 10), 2, std::vector<std::int32_t>(25, 0),
                      std::vector<std::uint64_t>(25)};
  for (const std::size_t inner : {6U, 7U, 8U, 11U, 12U, 13U, 16U, 17U, 18U}) partition.owner[inner] = 1;
  const auto offer = [](int) { return TileOffer{100, 10, 0}; };
  const std::vector<int> tiles = tiles_to_give({}, partition, 0, 1, {1e9, 1, kUnlimited}, offer);
  CHECK(tiles.size() == 4);  // a quarter of the ring
  for (const int tile : tiles) partition.owner[static_cast<std::size_t>(tile)] = 1;
  CHECK(is_connected(partition, 0));
}

TEST_CASE("local balancing: over random regions every transfer leaves the giver connected") {
  std::mt19937 random(7);
  int transfers = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Partition partition = random_growths(TileGrid(96, 80, 8), 5, seed);
    for (int round = 0; round < 20; ++round) {
      const int giver = static_cast<int>(random() % 5), taker = static_cast<int>(random() % 5);
      if (giver == taker) continue;
      const auto cost = [&](int tile) { return 20.0 + (37 * tile + 11 * round) % 80; };
      const auto offer = [&](int tile) { return TileOffer{cost(tile), 10, 0}; };
      const std::vector<int> tiles = tiles_to_give({}, partition, giver, taker, {1000, 1, kUnlimited}, offer);
      for (const int tile : tiles) partition.owner[static_cast<std::size_t>(tile)] = taker;
      INFO("seed " << seed << ", round " << round);
      REQUIRE(is_connected(partition, giver));
      transfers += tiles.empty() ? 0 : 1;
    }
  }
  CHECK(transfers > 100);
}

TEST_CASE("local balancing: regions that touch at a corner only transfer nothing") {
  Partition partition = test::halves();
  for (int tile = 0; tile < 32; ++tile) {
    partition.owner[static_cast<std::size_t>(tile)] =
        (tile % 8 < 4) == (tile / 8 < 2) ? (tile % 8 < 4 ? 0 : 1) : 2;
  }
  partition.ranks = 3;
  const auto offer = [](int) { return TileOffer{100, 10, 0}; };
  CHECK(tiles_to_give({}, partition, 0, 1, {1200, 1, kUnlimited}, offer).empty());
}

TEST_CASE("global balancing: imbalance is the ranks' standard deviation by their mean") {
  // Mean weights 1, 2 and 3: mean 2, variance 2/3. A rank without triangles does not count.
  const std::vector<std::vector<TileReport>> ranks = {
      {report(0, 1, 2, 1), report(1, 1, 2, 3)}, {report(2, 1, 4, 8)}, {report(3, 1, 1, 3)}, {}};
  CHECK(imbalance(ranks) == Approx(std::sqrt(2.0 / 3) / 2));
  CHECK(imbalance({}) == 0);
}

TEST_CASE("global balancing: a tile's predicted cost grows with its weight over the image's") {
  // Image: 10 triangles, weight 10, so A = 1. Tile 0 is at weight 4: four times its cost; tile 1 at 0.75.
  const std::vector<std::vector<TileReport>> ranks = {{report(0, 100, 1, 4)}, {report(1, 100, 8, 6)}};
  std::vector<double> costs = predicted_costs(TileGrid(30, 10, 10), ranks);
  const double a = 10.0 / 9;
  const double pixels = 100 * static_cast<double>(price(Work::kPixel));
  CHECK(costs[0] == Approx(100 * 4 / a + pixels));
  CHECK(costs[1] == Approx(100 * 0.75 / a + pixels));
  CHECK(costs[2] == Approx((costs[0] + costs[1]) / 2));  // nobody reported it
  for (const double c : predicted_costs(TileGrid(30, 10, 10), {})) CHECK(c == 1);
}

TEST_CASE("global balancing: what a region's received samples cost counts for its tiles") {
  std::vector<std::vector<TileReport>> ranks = {{report(0, 100, 5, 5)}, {report(1, 100, 5, 5)}};
  const double before = predicted_costs(TileGrid(20, 10, 10), ranks)[0];
  ranks[0][0].preparation = 50;
  const std::vector<double> costs = predicted_costs(TileGrid(20, 10, 10), ranks);
  CHECK(costs[0] == Approx(before + 50));
  CHECK(costs[1] == Approx(before));
}

TEST_CASE("local balancing: a rank begins to give beyond the noise, and goes on until it is even") {
  const LocalBalanceSettings settings{.giving_ratio = 1.2, .giving_noise = 2};
  CHECK_FALSE(should_begin_to_give(settings, 1.29, 0.05, false));
  CHECK(should_begin_to_give(settings, 1.31, 0.05, false));
  CHECK(should_begin_to_give(settings, 1.01, 0.05, true));
  CHECK_FALSE(should_begin_to_give(settings, 0.99, 0.05, true));
}

TEST_CASE("local balancing: a rank's load is the geometric mean over its neighbours") {
  const auto neighbour = [](double mean_weight, double future_cost) {
    return RankProgress{.mean_weight = mean_weight, .target_weight = 1, .future_cost = future_cost};
  };
  const std::vector neighbours = {neighbour(2, 20000), neighbour(2, 80000), neighbour(2, 40000),
                                  neighbour(0, 1e9)};  // of the last nothing is known
  CHECK(load_by_neighbours(neighbours, [](double) { return 80000.0; }) == Approx(2));
  CHECK(load_by_neighbours(neighbours, [](double) { return 10000.0; }) == Approx(0.25));
  CHECK(load_by_neighbours({}, [](double) { return 1.0; }) == 1);
}

TEST_CASE("local balancing: a rank's future cost is a time, by its pace") {
  const TileGrid grid(20, 10, 10);
  const Region region = Region::whole(grid);
  const std::array<TileWeights, 2> weights{
      {{.total_weight = 4, .count = 1}, {.total_weight = 2, .count = 1}}};
  const RegionQuality refined{region, weights, 3};
  CostEstimator costs(grid, work_of(traits_of(SamplerChoice::kDelaunay)));
  costs.begin_frame(true, FrameLikeness::kUnknown);
  Sample sample;
  sample.x = 4, sample.y = 5, sample.ray.rays = 20;
  costs.add_own(sample);
  costs.update(refined, 0.5);
  Balancer balancer(0, 2, costs);
  balancer.begin_frame(1);
  const RankProgress even = balancer.progress(refined, 0.5);
  REQUIRE(even.future_cost > 1300);
  const auto gives_to_like = [&](double pace) {
    balancer.begin_frame(pace);
    balancer.receive(1, even);
    return balancer.wants_to_give(refined, {1}, 0.5, false);
  };
  CHECK_FALSE(gives_to_like(1));
  CHECK(gives_to_like(4));  // of two triangles little is certain
  CHECK_FALSE(gives_to_like(0.5));
  const RankProgress slow = (balancer.begin_frame(2), balancer.progress(refined, 0.5));
  CHECK(slow.pace == 2);
  CHECK(slow.future_cost == Approx(2 * even.future_cost));
}

TEST_CASE("local balancing: what a tile costs is judged by the mean of the giver's and the taker's pace") {
  const Partition partition = test::halves();
  const Region own = region_of(partition, 0);
  std::vector<TileWeights> weights(32);
  CostEstimator costs(partition.grid, work_of(traits_of(SamplerChoice::kDelaunay)));
  costs.begin_frame(true, FrameLikeness::kUnknown);
  for (const int tile : own.tiles()) {
    const PixelRect rect = partition.grid.pixels(tile);
    Sample sample;
    sample.x = rect.x0 + 5, sample.y = rect.y0 + 5, sample.ray.rays = 20;
    costs.add_own(sample);
    weights[static_cast<std::size_t>(tile)] = {.total_weight = 4, .count = 1};
  }
  const RegionQuality refined{own, weights, 4};
  costs.update(refined, 0.5);
  TransferHandshake handshake(2);
  handshake.receive(1, {});
  handshake.set_giving(true);
  const std::vector<int> beside = {1};
  const KnownRanks others{partition, beside, [](int) { return std::vector<std::uint32_t>(32, 0); }};
  // Three tenths of what 16 tiles cost are to move: four tiles at most, two of double the cost.
  const auto given_to_rank_of = [&](double pace) {
    Balancer balancer(0, 2, costs);
    balancer.begin_frame(1);
    balancer.receive(1, {.mean_weight = 1, .target_weight = 0.5, .future_cost = 0, .pace = pace});
    return balancer.choose_transfers(refined, others, handshake, 0.5, kUnlimited).size();
  };
  CHECK(given_to_rank_of(1) == 4);
  CHECK(given_to_rank_of(3) == 2);
}

TEST_CASE("global balancing: a resting picture is cut anew only if few samples change hands") {
  for (const bool is_even : {true, false}) {
    SessionSettings settings{.sampler = SamplerChoice::kAuto};
    settings.balance = BalanceMode::kGlobal;
    settings.frames_per_second = 25;
    constexpr double kUnitsPerFrame = 1e5;  // a twentieth of it takes in some ten samples
    GlobalBalancer balancer(settings, traits_of(settings.sampler), TileGrid(40, 10, 10), 2, kUnitsPerFrame);
    FrameReports frame = reports_of_two(1000, is_even ? 1 : 4);
    for (std::vector<TileReport>& tiles : frame.tiles)
      for (TileReport& tile : tiles) tile.cost = 1e6;
    frame.accumulates = true;
    CHECK(repartitions(balancer, frame, Carry::kAccumulate) == is_even);
    // Where samples are dropped there is nothing to take in.
    settings.keep_samples = false;
    GlobalBalancer dropping(settings, traits_of(settings.sampler), TileGrid(40, 10, 10), 2, kUnitsPerFrame);
    CHECK(repartitions(dropping, frame, Carry::kAccumulate));
  }
}

EACH_SAMPLER_TEST_CASE("global balancing: tiles of a lost rank go to the others, whatever had accumulated") {
  for (const Carry next : {Carry::kNothing, Carry::kCastWherePaying, Carry::kAccumulate}) {
    SessionSettings settings{.sampler = sampler};
    settings.balance = BalanceMode::kNone;
    GlobalBalancer balancer = balancer_of_two(settings);
    FrameReports frame = reports_of_two(1, 4);
    frame.accumulates = true;
    balancer.consider(frame);
    constexpr std::int32_t kLost = 1;
    balancer.take_over({&kLost, 1});
    FrameOrder order;
    order.carry = next;
    balancer.add_partition(order);
    CHECK(order.owners == std::vector<std::int32_t>(4, 0));
  }
}

TEST_CASE("global balancing: a frame that is not whole tells nothing") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.balance = BalanceMode::kCombined;
  GlobalBalancer balancer = balancer_of_two(settings);
  FrameReports torn = reports_of_two(1000, 9);
  torn.is_whole = false;
  CHECK_FALSE(repartitions(balancer, torn));
  CHECK_FALSE(repartitions(balancer, reports_of_two(1000, 1)));
  CHECK(repartitions(balancer, reports_of_two(1000, 9)));
}

TEST_CASE("global balancing: a resting picture of more samples than pixels is not cut anew") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.balance = BalanceMode::kGlobal;
  settings.frames_per_second = 25;
  settings.width = 40, settings.height = 10;
  for (const std::uint64_t samples : {400U, 401U}) {
    GlobalBalancer balancer(settings, traits_of(settings.sampler), TileGrid(40, 10, 10), 2, 1e12);
    FrameReports frame = reports_of_two(1, 4);
    frame.accumulates = true, frame.samples = samples;
    CHECK(repartitions(balancer, frame, Carry::kAccumulate) == (samples == 400));
  }
}

TEST_CASE("global balancing: each new owner is told what its tiles were found to be") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.balance = BalanceMode::kGlobal;
  GlobalBalancer balancer = balancer_of_two(settings);
  FrameReports frame = reports_of_two(4, 1);
  for (std::size_t rank = 0; rank < 2; ++rank)
    for (TileReport& tile : frame.tiles[rank]) tile.cost = 100 + tile.tile, tile.total_weight = 8 + tile.tile;
  frame.tiles[1][1].triangles = 0;
  balancer.consider(frame);
  FrameOrder order;
  balancer.add_partition(order);
  CHECK((order.columns == 4 && order.generation == 1));
  REQUIRE(order.owners == std::vector<std::int32_t>{0, 0, 1, 1});
  const std::vector<std::vector<TileEstimate>> found = balancer.estimates_for(order);
  REQUIRE((found.size() == 2 && found[0].size() == 2 && found[1].size() == 2));
  CHECK((found[0][1].cost == 101 && found[0][1].average_weight == 9.0 / 4));
  CHECK((found[1][0].cost == 102 && found[1][0].average_weight == 10.0 / 4));
  CHECK((found[1][1].cost == 103 && found[1][1].average_weight == 0));
}

TEST_CASE("global balancing: on a lattice, a partition from accumulated samples serves no new picture") {
  const auto is_made = [](SamplerChoice sampler, bool accumulated, Carry next) {
    SessionSettings settings{.sampler = sampler};
    settings.balance = BalanceMode::kGlobal;
    GlobalBalancer balancer = balancer_of_two(settings);
    FrameReports frame = reports_of_two(1, 4);
    frame.accumulates = accumulated;
    return repartitions(balancer, frame, next);
  };
  for (const Carry next : {Carry::kNothing, Carry::kCastWherePaying}) {
    CHECK(is_made(SamplerChoice::kAuto, false, next));
    CHECK_FALSE(is_made(SamplerChoice::kAuto, true, next));
    CHECK(is_made(SamplerChoice::kDelaunay, true, next));
  }
  CHECK(is_made(SamplerChoice::kAuto, true, Carry::kAccumulate));
}

TEST_CASE("global balancing: a rank alone is never given a partition") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.balance = BalanceMode::kGlobal;
  GlobalBalancer alone(settings, traits_of(settings.sampler), TileGrid(40, 10, 10), 1, 0);
  CHECK_FALSE(repartitions(alone, {.tiles = {{report(0, 100, 9, 1), report(1, 1, 9, 9)}}, .speeds = {1}}));
}

EACH_SAMPLER_TEST_CASE("balancing: every mode evens the refinement out") {
  const auto evened = [&](BalanceMode mode) {
    const SessionSettings settings = without_carrying(sampler, mode);
    const VirtualRun run = run_session(9, settings, still_or_pan(settings, 16, 0));
    CHECK(run.error.empty());
    REQUIRE(run.frames.size() == 16);
    const VirtualRun again =
        run_session(9, settings, still_or_pan(settings, 16, 0), {.slow_at_random = true});
    CHECK(same_pictures(run, again));
    for (const FinishedFrame& frame : run.frames) CHECK(frame.late_ms <= 0);
    double sum = 0;
    for (std::size_t i = 12; i < 16; ++i) sum += unevenness(run.frames[i]) / 4;
    return sum;
  };
  const double none = evened(BalanceMode::kNone), local = evened(BalanceMode::kLocal);
  const double global = evened(BalanceMode::kGlobal), combined = evened(BalanceMode::kCombined);
  CAPTURE(none, local, global, combined);
  // Slow where regions are small: only the worst of a neighbourhood gives, and little at a time.
  CHECK(local < 0.92 * none);
  CHECK(global < 0.5 * none);
  // The roots of weights deviate less, and a partition is made where they deviate much.
  CHECK(combined < (traits_of(sampler).weights_are_roots ? 0.6 : 0.5) * none);
}

// Orders go a frame ahead, except the two after a picture of which nothing is known.
EACH_SAMPLER_TEST_CASE(
    "global balancing: a partition is in force two frames after the one it was made from, one after a cut") {
  const SessionSettings settings = without_carrying(sampler, BalanceMode::kGlobal);
  const CameraSource still = still_or_pan(settings, 8, 0);
  const auto with_cut = [&](int index) {
    std::optional<FrameRequest> request = still(index);
    if (request && index == 4) request->cut = true;
    return request;
  };
  const VirtualRun run = run_session(4, settings, with_cut);
  std::vector<bool> repartitioned;
  for (const FinishedFrame& frame : run.frames) repartitioned.push_back(frame.global_balance);
  // Made from the frames: none, 0, 1, none, 2, 4, 5, none.
  CHECK(repartitioned == std::vector<bool>{false, true, true, false, true, true, true, false});
}

EACH_SAMPLER_TEST_CASE("combined balancing: what regions of few triangles show may be chance") {
  SessionSettings settings{.sampler = sampler};
  settings.balance = BalanceMode::kCombined;
  const auto is_made = [&](int triangles) {
    GlobalBalancer balancer = balancer_of_two(settings);
    return repartitions(balancer, reports_of_two(triangles, 2));  // deviates by a third of the mean
  };
  CHECK(is_made(500));
  CHECK_FALSE(is_made(50));
}

EACH_SAMPLER_TEST_CASE(
    "combined balancing: samples are not handed over again before the last partition's effect is known") {
  SessionSettings settings{.sampler = sampler};
  settings.balance = BalanceMode::kCombined;
  GlobalBalancer balancer = balancer_of_two(settings);
  const auto is_made = [&](std::uint32_t generation, bool accumulates) {
    FrameReports frame = reports_of_two(1000, 4);
    frame.generation = generation;
    frame.accumulates = accumulates;
    return repartitions(balancer, frame, accumulates ? Carry::kAccumulate : Carry::kNothing);
  };
  CHECK(is_made(0, true));
  CHECK_FALSE(is_made(0, true));  // ordered before that partition was in force
  CHECK(is_made(1, true));
  CHECK(is_made(1, false));  // nothing is handed over
}

}  // namespace pprt::balance_test
