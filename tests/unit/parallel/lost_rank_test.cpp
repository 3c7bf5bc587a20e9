// Ranks that answer no more: who notices, who takes over, when the run ends.
#include <algorithm>
#include <catch2/catch.hpp>
#include <future>
#include <set>
#include <utility>

#include "image/metrics.h"
#include "parallel/master/loss_watch.h"
#include "parallel/network/local_communicator.h"
#include "unit/each_sampler.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::lost_rank_test {
namespace {

constexpr int kFrames = 30;

SessionSettings real_time(SamplerChoice sampler, BalanceMode balance = BalanceMode::kCombined) {
  SessionSettings settings{.sampler = sampler};
  settings.width = 96, settings.height = 64;
  settings.clock = ClockKind::kWall;
  settings.frames_per_second = 10;
  settings.balance = balance;
  return settings;
}

// What the sequence ends with when no rank is lost, without waiting for its deadlines.
FinishedFrame last_frame_of_counted_work(SamplerChoice sampler, double shift) {
  SessionSettings settings = real_time(sampler);
  settings.clock = ClockKind::kWork;
  settings.budget_units = 3'000'000;
  VirtualRun run = run_session(4, settings, still_or_pan(settings, kFrames, shift));
  REQUIRE(run.frames.size() == kFrames);
  return std::move(run.frames.back());
}

double rmse(const Image& a, const Image& b) {
  return difference(a, b, 0).rmse;
}

struct RunWithLoss {
  VirtualRun run;
  std::vector<int> told;  // to be lost
};

// In real time; rank 2 is cut off.
RunWithLoss lose_rank_2(SamplerChoice sampler, BalanceMode balance, double shift) {
  const SessionSettings settings = real_time(sampler, balance);
  RunWithLoss result;
  Conditions conditions{.unplugged = {2}, .unplugged_at_s = 0.5};
  conditions.loss = {.patience_s = 0.5, .goes_on = true};
  conditions.loss.told = [&](std::span<const int> ranks) { result.told.assign(ranks.begin(), ranks.end()); };
  result.run = run_session(4, settings, still_or_pan(settings, kFrames, shift), conditions);
  return result;
}

EACH_SAMPLER_TEST_CASE("lost ranks: the others take over, and the picture is whole again",
                       "[realtime][alone]") {
  for (const double shift : {0.0, 1.0}) {  // a resting camera accumulates samples, some of which are lost
    const FinishedFrame undisturbed = last_frame_of_counted_work(sampler, shift);
    // Both at a time: each waits for its next frame most of the time.
    std::future<RunWithLoss> both[] = {
        std::async(std::launch::async, lose_rank_2, sampler, BalanceMode::kNone, shift),
        std::async(std::launch::async, lose_rank_2, sampler, BalanceMode::kCombined, shift)};
    for (std::future<RunWithLoss>& one : both) {
      const auto [run, told] = one.get();
      INFO(run.error);
      CHECK(run.error.empty());
      CHECK(told == std::vector<int>{2});
      REQUIRE(run.frames.size() == kFrames);
      // The frames between loss and take-over show what rank 2 sent last.
      CHECK(std::any_of(run.frames.begin(), run.frames.end(), [](const FinishedFrame& f) {
        return f.late_ranks == std::vector<std::int32_t>{2} && f.stale_tiles > 0;
      }));
      const FinishedFrame& last = run.frames.back();
      CHECK(last.order.lost == std::vector<std::int32_t>{2});
      const auto is_whole = [](const FinishedFrame& f) {
        return !f.order.lost.empty() && f.stale_tiles == 0 &&
               std::count(f.owners.begin(), f.owners.end(), 2) == 0;
      };
      CHECK(std::count_if(run.frames.begin(), run.frames.end(), is_whole) >= 5);
      CHECK(rmse(last.image, undisturbed.image) < 0.02);
      if (shift > 0) CHECK(rmse(run.frames[0].image, last.image) > 0.05);
    }
  }
}

EACH_SAMPLER_TEST_CASE("lost ranks: a run that does not go on ends once no rank of a host answers",
                       "[realtime]") {
  const SessionSettings settings = real_time(sampler);
  Conditions conditions{.unplugged_at_s = 0.4, .patience_s = 2};
  conditions.loss.patience_s = 0.5;
  conditions.loss.host_of = [](int rank) { return rank < 2 ? "alpha" : "beta"; };
  const auto run_without = [&](std::set<int> ranks) {
    Conditions cut = conditions;
    cut.unplugged = std::move(ranks);
    return run_session(4, settings, still_or_pan(settings, kFrames, 1), cut);
  };
  std::future<VirtualRun> one_lost = std::async(std::launch::async, run_without, std::set{3});  // may be slow
  CHECK_THAT(run_without({2, 3}).error, Catch::Contains("no answer for 0.5 s from ranks 2 to 3 on beta"));
  CHECK(one_lost.get().frames.size() == kFrames);
}

TEST_CASE("lost ranks: ranks are named by host, those in a row together") {
  const auto host_of = [](int rank) { return rank < 4 ? std::string("alpha") : std::string("beta"); };
  CHECK(name_ranks(std::vector{2}, host_of) == "rank 2 on alpha");
  CHECK(name_ranks(std::vector{1, 2, 3, 4, 5, 7}, host_of) ==
        "ranks 1 to 3 on alpha, ranks 4 to 5 on beta, rank 7 on beta");
  CHECK(name_ranks(std::vector{3, 4}, [](int) { return std::string(); }) == "ranks 3 to 4");
}

TEST_CASE("lost ranks: a rank that no frame waits for may be silent") {
  double now_s = 0;
  LocalNetwork network(2);
  LocalCommunicator end(network, 0);
  RankClocks clocks(end, [&] { return now_s; });
  LossWatch watch({.patience_s = 3, .goes_on = true}, clocks, 2);
  clocks.watch();
  const auto lost_after = [&](double seconds, bool awaited) {
    for (const double until = now_s + seconds; now_s < until; now_s += 0.25) clocks.look();
    return watch.newly_lost([awaited](int) { return awaited; });
  };
  CHECK(lost_after(5, false).empty());
  CHECK(lost_after(1, true) == std::vector<int>{1});
  CHECK(lost_after(5, true).empty());  // told once
}

}  // namespace
}  // namespace pprt::lost_rank_test
