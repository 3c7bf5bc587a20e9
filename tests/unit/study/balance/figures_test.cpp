// Figures of recorded runs: counted by hand on made-up frames, and explained by what ranks recorded in runs.
#include "study/balance/figures.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "base/diagnostics.h"
#include "parallel/settings/session_words.h"
#include "unit/each_sampler.h"
#include "unit/study/balance/recorded_run.h"

namespace pprt::figures_test {
namespace {

// Two ranks, the second one at half speed, on two tiles. `cost`: of the second tile, work units.
TracedFrame some_frame(std::vector<std::int32_t> owners, double cost = 3e6) {
  return {.ranks = {{.pace = 1}, {.pace = 2}},
          .owners = std::move(owners),
          .tiles = {{.tile = 0, .triangles = 10, .total_weight = 10, .cost = 1e6},
                    {.tile = 1, .triangles = 10, .total_weight = 10, .cost = cost}}};
}

const TileGrid kGrid(4, 2, 2);

// Returns who owns each tile after the frame's transfers, in the order of the exchanges.
std::vector<std::int32_t> after_transfers(std::vector<std::int32_t> owners,
                                          std::vector<TransferChoice> transfers) {
  std::stable_sort(transfers.begin(), transfers.end(),
                   [](const TransferChoice& a, const TransferChoice& b) { return a.round < b.round; });
  for (const TransferChoice& choice : transfers) {
    for (const GivenTile& given : choice.given) {
      CHECK(owners[static_cast<std::size_t>(given.tile)] == choice.giver);
      owners[static_cast<std::size_t>(given.tile)] = given.taker;
    }
  }
  return owners;
}

}  // namespace

TEST_CASE("balancing figures: loads are predicted costs of the tiles owned, by pace") {
  TracedFrame frame = some_frame({0, 1});
  const std::vector<double> apart = loads(kGrid, frame, {0, 1});
  REQUIRE(apart.size() == 2);
  const double reconstruction = apart[0] - 1e6;
  CHECK(reconstruction > 0);
  CHECK(apart[1] == Approx(2 * (3e6 + reconstruction)));
  const std::vector<double> together = loads(kGrid, frame, {0, 0});
  CHECK(together[0] == Approx(4e6 + 2 * reconstruction));
  CHECK(together[1] == 0);
  frame.lost_ranks = {1};
  CHECK(loads(kGrid, frame, {0, 0}).size() == 1);
}

TEST_CASE("balancing figures: deviation, largest load and tiles moved, by hand") {
  BalanceTrace run{.header = {},
                   .frames = {some_frame({0, 1}, 1e9), some_frame({1, 0}, 1e9), some_frame({-1, 0}, 1e9)}};
  run.header.ranks = 2, run.header.grid = kGrid;
  run.frames[0].number = 5;
  run.frames[1].repartitioned = true;
  run.frames[2].transfers = {{.giver = 0, .round = 1, .given = {{0, 1}, {1, 1}}},
                             {.giver = 1, .round = 2, .given = {{1, 0}}}};
  const std::vector<FrameFigures> figures = figures_of(run);
  REQUIRE(figures.size() == 3);
  // Loads of about 0 and 2: deviation 1, largest load twice the mean.
  CHECK(
      (figures[0].frame == 5 && figures[0].moved == 0 && figures[0].given == 0 && !figures[0].repartitioned));
  CHECK(figures[0].deviation == Approx(1).margin(0.01));
  CHECK(figures[0].worst == Approx(2).margin(0.01));
  CHECK((figures[1].owners == std::vector{1, 0} && figures[1].moved == 2 && figures[1].repartitioned));
  CHECK((figures[2].owners == std::vector{1, 0} && figures[2].moved == 0 && figures[2].given == 3));
}

TEST_CASE("balancing figures: what ranks recorded explains who owns each tile") {
  for (const BalanceMode mode :
       {BalanceMode::kNone, BalanceMode::kLocal, BalanceMode::kGlobal, BalanceMode::kCombined}) {
    for (const SamplerChoice sampler : kEachSampler) {
      INFO(word_for(mode) << ", " << word_for(sampler));
      const BalanceTrace run = recorded_run(uneven_settings(sampler, mode));
      const std::vector<FrameFigures> figures = figures_of(run);
      int given = 0, repartitions = 0;
      for (std::size_t i = 0; i < figures.size(); ++i) {
        CHECK(figures[i].owners == run.frames[i].owners);
        given += figures[i].given, repartitions += figures[i].repartitioned;
        if (i > 0 && !figures[i].repartitioned)
          CHECK(after_transfers(figures[i - 1].owners, run.frames[i].transfers) == figures[i].owners);
      }
      CHECK((given > 0) == (mode == BalanceMode::kLocal || mode == BalanceMode::kCombined));
      CHECK((repartitions > 0) == (mode == BalanceMode::kGlobal || mode == BalanceMode::kCombined));
    }
  }
}

TEST_CASE("balancing figures: runs that balance have a lower deviation of the loads") {
  const auto deviation = [](BalanceMode mode) {
    return figures_of(recorded_run(uneven_settings(SamplerChoice::kDelaunay, mode))).back().deviation;
  };
  const double unbalanced = deviation(BalanceMode::kNone);
  CHECK(unbalanced > 0.3);
  for (const BalanceMode mode : {BalanceMode::kLocal, BalanceMode::kGlobal, BalanceMode::kCombined}) {
    INFO(word_for(mode));
    CHECK(deviation(mode) < 0.5 * unbalanced);
  }
}

TEST_CASE("balancing figures: figures that make no sense are borne") {
  const BalanceTrace run =
      recorded_run(uneven_settings(SamplerChoice::kDelaunay, BalanceMode::kCombined), 4, 4);
  std::string text = trace_line(run.header);
  for (const TracedFrame& frame : run.frames) text += trace_line(frame);
  std::mt19937 random(3);
  int read = 0;
  for (int i = 0; i < 300; ++i) {
    std::string broken = text;
    for (int change = 0; change < 12; ++change) {
      char& c = broken[random() % broken.size()];
      if (c >= '0' && c <= '9') c = static_cast<char>('0' + random() % 10);
      if (c == '.') c = "0e"[random() % 2];
    }
    try {
      for (const BalanceTrace& parsed : parse_balance_trace(broken, "t").runs) {
        for (const FrameFigures& frame : figures_of(parsed)) {
          CHECK(std::all_of(frame.owners.begin(), frame.owners.end(),
                            [&](std::int32_t owner) { return owner >= 0 && owner < parsed.header.ranks; }));
        }
        ++read;
      }
    } catch (const InputError&) {
    }
  }
  CHECK(read > 20);
}

}  // namespace pprt::figures_test
