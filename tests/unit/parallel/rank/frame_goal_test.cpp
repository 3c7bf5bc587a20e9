// When a rank has done its part of a frame without a rate, and when all have: by hand.
#include "parallel/rank/frame_goal.h"

#include <catch2/catch.hpp>

#include "unit/parallel/rank/one_rank.h"

namespace pprt::frame_goal_test {
namespace {

using test::OneRank;

struct Goal : OneRank {
  explicit Goal(const StopRules& stop, int rank = 0, int ranks = 1)
      : OneRank(settings_of(stop), rank, ranks), goal(settings, rank, ranks, tracer) {
    is_wavy = true;
    tracer.begin_frame({});
    goal.begin_frame(1, true);
  }

  bool is_reached() { return goal.is_reached(sampling, picture, clock); }
  SamplingProgress progress() { return goal.progress(sampling, clock); }

  // Takes samples until the goal is reached; returns how many there are in the region.
  std::uint64_t samples_until_reached(std::uint64_t most = 5000) {
    while (!is_reached() && sampling.in_region() < most) REQUIRE(sampling.refine(nullptr));
    return sampling.in_region();
  }

  PictureRefresh picture;
  FrameGoal goal;
};

}  // namespace

TEST_CASE("frame goal: each rank takes its pixels' share of the samples, rounded up") {
  CHECK(Goal({.samples = 1000}).samples_until_reached() == 1000);
  CHECK(Goal({.samples = 1000}, 0, 2).samples_until_reached() == 500);
  CHECK(Goal({.samples = 1001}, 0, 2).samples_until_reached() == 501);
  CHECK(Goal({.samples = 1001}, 3, 4).samples_until_reached() == 251);
}

TEST_CASE("frame goal: without a rule no number of samples is enough, and with several the first counts") {
  CHECK(Goal({}).samples_until_reached(2000) == 2000);
  Goal both({.seconds = 1e9, .samples = 300});
  CHECK(both.samples_until_reached() == 300);
  Goal early({.seconds = 1e-9, .samples = 300});
  CHECK_FALSE(early.is_reached());
  early.clock.spend(Work::kRay, 1);
  CHECK(early.is_reached());
}

TEST_CASE("frame goal: time ends a frame when it has passed, by the clock's seconds") {
  Goal timed({.seconds = 2});
  timed.clock.spend(Work::kRay, static_cast<std::uint64_t>(2 * kWorkUnitsPerSecond) / price(Work::kRay));
  CHECK_FALSE(timed.is_reached());
  timed.clock.spend(Work::kRay, 1);
  CHECK(timed.is_reached());
}

TEST_CASE("frame goal: a region is refined when a sample's worth has fallen so far") {
  Goal weighed({.weight = 1e9});
  weighed.sampling.trace_seeds();
  CHECK(weighed.samples_until_reached() == 81);
  Goal fine({.weight = 1e-12});
  fine.sampling.trace_seeds();
  CHECK(fine.samples_until_reached(2000) == 2000);
}

TEST_CASE("frame goal: all have done when this rank and every other has said so, in this frame") {
  Goal rank({.samples = 10}, 1, 3);
  FrameGoal& goal = rank.goal;
  CHECK_FALSE(goal.is_done());
  goal.receive(0, true, {});
  goal.receive(2, true, {});
  CHECK_FALSE(goal.all_done());
  goal.set_done(true);
  CHECK((goal.is_done() && goal.all_done()));
  goal.receive(2, false, {});  // it has got tiles
  CHECK_FALSE(goal.all_done());
  goal.receive(2, true, {});
  CHECK(goal.all_done());
  goal.begin_frame(2, false);
  CHECK_FALSE(goal.is_done());
  goal.set_done(true);
  CHECK_FALSE(goal.all_done());
  Goal alone({.samples = 10});
  CHECK_FALSE(alone.goal.all_done());
  alone.goal.set_done(true);
  CHECK(alone.goal.all_done());
}

TEST_CASE("frame goal: progress is that of the rule that is nearest, and a density of samples") {
  Goal nothing({});
  CHECK((!nothing.progress().share && nothing.progress().samples_per_pixel == 0));
  Goal rank({.seconds = 2, .samples = 1000}, 0, 2);
  CHECK(rank.progress().share == 0.0);
  while (rank.sampling.in_region() < 125) rank.sampling.refine(nullptr);
  const double by_time = rank.clock.frame_seconds() / 2;
  REQUIRE(by_time < 0.25);
  CHECK(*rank.progress().share == Approx(125 / 500.0));
  CHECK(rank.progress().samples_per_pixel == Approx(125.0 / (32 * 64)));
  rank.clock.spend(Work::kRay, static_cast<std::uint64_t>(kWorkUnitsPerSecond) / price(Work::kRay));
  CHECK(*rank.progress().share == Approx(by_time + 0.5).epsilon(1e-3));
  rank.clock.spend(Work::kRay, static_cast<std::uint64_t>(9 * kWorkUnitsPerSecond) / price(Work::kRay));
  CHECK(rank.progress().share == 1.0);
}

}  // namespace pprt::frame_goal_test
