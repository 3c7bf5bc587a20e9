// The policy that ran, replayed from its trace, makes the recorded decisions again; another one does not.
#include "study/balance/replay.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "base/diagnostics.h"
#include "parallel/session_words.h"
#include "unit/study/balance/recorded_run.h"

namespace pprt {
namespace {

constexpr BalanceMode kAll[] = {BalanceMode::kNone, BalanceMode::kLocal, BalanceMode::kGlobal,
                                BalanceMode::kCombined};

int sum_of(const std::vector<ReplayedRound>& rounds, int ReplayedRound::*member) {
  return std::accumulate(rounds.begin(), rounds.end(), 0,
                         [&](int sum, const ReplayedRound& round) { return sum + round.*member; });
}

int differing(const BalanceTrace& run, BalanceMode policy, const LocalBalanceSettings& local = {}) {
  return sum_of(replay(run, policy, local), &ReplayedRound::differing);
}

// What happened in the run, by its trace alone.
int given(const BalanceTrace& run) {
  std::size_t tiles = 0;
  for (const TracedFrame& frame : run.frames) {
    for (const TransferChoice& choice : frame.transfers) tiles += choice.given.size();
  }
  return static_cast<int>(tiles);
}

int repartitions(const BalanceTrace& run) {
  return static_cast<int>(std::count_if(run.frames.begin(), run.frames.end(),
                                        [](const TracedFrame& frame) { return frame.repartitioned; }));
}

void check_exact(const BalanceTrace& run) {
  const std::vector<ReplayedRound> rounds = replay(run, run.header.settings.balance);
  REQUIRE(rounds.size() == run.frames.size());
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    CHECK(rounds[i].owners == run.frames[i].owners);
    CHECK(rounds[i].repartitioned == run.frames[i].repartitioned);
    CHECK(rounds[i].differing == 0);
  }
}

}  // namespace

TEST_CASE("balancing replay: the policy that ran owns the recorded tiles, every other one others") {
  for (const BalanceMode ran : kAll) {
    for (const SamplerChoice sampler : {SamplerChoice::kDelaunay, SamplerChoice::kAuto}) {
      const SessionSettings settings = uneven_settings(sampler, ran);
      INFO(word_for(ran) << ", " << word_for(sampler));
      const BalanceTrace run = recorded_run(settings);
      check_exact(run);
      CHECK((given(run) > 0) == (ran == BalanceMode::kLocal || ran == BalanceMode::kCombined));
      CHECK((repartitions(run) > 0) == (ran == BalanceMode::kGlobal || ran == BalanceMode::kCombined));
      for (const BalanceMode other : kAll) {
        INFO("replayed as " << word_for(other));
        CHECK((differing(run, other) == 0) == (other == ran));
      }
    }
  }
}

TEST_CASE("balancing replay: carried samples, a slow network and no rate change nothing of that") {
  for (const BalanceMode ran : {BalanceMode::kLocal, BalanceMode::kCombined}) {
    SessionSettings settings = uneven_settings(SamplerChoice::kDelaunay, ran);
    settings.cast = CastChoice::kVerified;
    check_exact(recorded_run(settings));
    settings.machine.latency_s = 1e-3;
    check_exact(recorded_run(settings, 7, 5));
    settings = uneven_settings(SamplerChoice::kDelaunay, ran);
    settings.frames_per_second = 0;
    settings.budget_units = 0;
    settings.stop.weight = 0.05;
    check_exact(recorded_run(settings, 4, 3));
  }
}

TEST_CASE("balancing replay: decisions are made again, not copied: other constants make others") {
  const BalanceTrace run = recorded_run(uneven_settings(SamplerChoice::kDelaunay, BalanceMode::kLocal));
  LocalBalanceSettings changed;
  changed.share = 0.1;
  CHECK(differing(run, BalanceMode::kLocal, changed) > 0);
  changed = {};
  changed.cost_ratio = 1e6;  // nobody is ahead enough
  CHECK(sum_of(replay(run, BalanceMode::kLocal, changed), &ReplayedRound::moved) == 0);
}

TEST_CASE("balancing replay: a change of the recorded figures changes the decisions") {
  BalanceTrace run = recorded_run(uneven_settings(SamplerChoice::kDelaunay, BalanceMode::kGlobal));
  for (TracedFrame& frame : run.frames) {
    for (std::size_t t = 0; t < frame.tiles.size() / 2; ++t) frame.tiles[t].cost *= 4;
  }
  CHECK(differing(run, BalanceMode::kGlobal) > 0);
}

TEST_CASE("balancing replay: policies that balance lower the deviation of the loads") {
  const BalanceTrace run = recorded_run(uneven_settings(SamplerChoice::kDelaunay, BalanceMode::kNone));
  const double unbalanced = replay(run, BalanceMode::kNone).back().deviation;
  CHECK(unbalanced > 0.3);
  for (const BalanceMode policy : {BalanceMode::kLocal, BalanceMode::kGlobal, BalanceMode::kCombined}) {
    INFO(word_for(policy));
    const std::vector<ReplayedRound> rounds = replay(run, policy);
    CHECK(rounds.back().deviation < 0.5 * unbalanced);
    CHECK(sum_of(rounds, &ReplayedRound::moved) > 0);
  }
  const std::vector<ReplayedRound> unmoved = replay(run, BalanceMode::kNone);
  CHECK(sum_of(unmoved, &ReplayedRound::moved) == 0);
}

TEST_CASE("balancing replay: figures that make no sense are borne") {
  const BalanceTrace run =
      recorded_run(uneven_settings(SamplerChoice::kDelaunay, BalanceMode::kCombined), 4, 4);
  std::string text = trace_line(run.header);
  for (const TracedFrame& frame : run.frames) text += trace_line(frame);
  std::mt19937 random(3);
  int replayed = 0;
  for (int i = 0; i < 300; ++i) {
    std::string broken = text;
    for (int change = 0; change < 12; ++change) {
      char& c = broken[random() % broken.size()];
      if (c >= '0' && c <= '9') c = static_cast<char>('0' + random() % 10);
      if (c == '.') c = "0e"[random() % 2];
    }
    try {
      for (const BalanceTrace& read : parse_balance_trace(broken, "t").runs) {
        for (const BalanceMode policy : kAll) {
          for (const ReplayedRound& round : replay(read, policy)) {
            CHECK(std::all_of(round.owners.begin(), round.owners.end(),
                              [&](std::int32_t owner) { return owner >= 0 && owner < read.header.ranks; }));
          }
        }
        ++replayed;
      }
    } catch (const InputError&) {
    }
  }
  CHECK(replayed > 20);
}

TEST_CASE("balancing replay: loads are predicted costs of the tiles owned, by pace") {
  TraceHeader header;
  header.ranks = 2;
  header.grid = TileGrid(4, 2, 2);
  TracedFrame frame{.ranks = {{.pace = 1}, {.pace = 2}},
                    .owners = {0, 1},
                    .tiles = {{.tile = 0, .triangles = 10, .total_weight = 10, .cost = 1e6},
                              {.tile = 1, .triangles = 10, .total_weight = 10, .cost = 3e6}}};
  const std::vector<double> apart = loads(header, frame, {0, 1});
  REQUIRE(apart.size() == 2);
  const double reconstruction = apart[0] - 1e6;
  CHECK(reconstruction > 0);
  CHECK(apart[1] == Approx(2 * (3e6 + reconstruction)));
  const std::vector<double> together = loads(header, frame, {0, 0});
  CHECK(together[0] == Approx(4e6 + 2 * reconstruction));
  CHECK(together[1] == 0);
  frame.lost_ranks = {1};
  CHECK(loads(header, frame, {0, 0}).size() == 1);
}

}  // namespace pprt
