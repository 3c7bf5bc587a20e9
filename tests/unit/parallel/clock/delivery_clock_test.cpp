#include "parallel/clock/delivery_clock.h"

#include <catch2/catch.hpp>

#include "parallel/clock/make_clocks.h"

namespace pprt::delivery_clock_test {

TEST_CASE("without a rate time begins with the first frame, not at the common start") {
  double now = 10;
  WallDeliveryClock clock(0, 1, false, [&now] { return now; });
  clock.begin_sequence(10.005);
  now = 10.002;
  CHECK(clock.delivery_time(FrameOrder(), {}).finished_s == Approx(0.002));
  CHECK(clock.delivery_time(FrameOrder(), {}).late_ms == 0);
}

TEST_CASE("ranks that share a core have their share of a frame's work units") {
  const auto units = [](double ranks_per_core) {
    return WallDeliveryClock(10, ranks_per_core, false, [] { return 0.0; }).units_per_frame();
  };
  CHECK(units(1) == Approx(1e8));
  CHECK(units(4) == Approx(0.25e8));
}

TEST_CASE("with a rate time begins at the common start") {
  double now = 10;
  WallDeliveryClock clock(4, 1, false, [&now] { return now; });
  clock.begin_sequence(10.005);
  now = 10.255;
  FrameOrder order;
  order.deadline_s = 0.25;
  CHECK(clock.delivery_time(order, {}).finished_s == Approx(0.25));
  CHECK(clock.delivery_time(order, {}).late_ms == Approx(0).margin(1e-6));
}

TEST_CASE("a frame is prepared beside the one before until that one is due, but not on a shared core") {
  double now = 10;
  WallDeliveryClock clock(4, 1, false, [&now] { return now; }), shared(4, 2, false, [&now] { return now; });
  clock.begin_sequence(10), shared.begin_sequence(10);
  now = 10.2;
  CHECK(clock.may_overlap(1));
  CHECK_FALSE(shared.may_overlap(1));
  now = 10.3;
  CHECK_FALSE(clock.may_overlap(1));
  CHECK(clock.may_overlap(2));
}

TEST_CASE("on the work clock a frame is finished when its slowest rank has done its work") {
  const WorkDeliveryClock clock(4, 5'000'000);  // units are a tenth of a second
  CHECK(clock.deadline_s(0, 0) == Approx(0.25));
  CHECK(clock.deadline_s(2, 0) == Approx(0.75));
  CHECK(clock.deadline_s(2, 3) == Approx(1.5));  // frames of the script that nobody renders pass, too
  std::vector<RankReport> ranks(3);
  ranks[0].finished_s = 0.08, ranks[1].finished_s = 0.13, ranks[2].finished_s = 0.1;
  FrameOrder order;
  order.deadline_s = 0.75;
  CHECK(clock.delivery_time(order, ranks).finished_s == Approx(0.5 + 0.13));
  CHECK(clock.delivery_time(order, ranks).late_ms == Approx(30));
  ranks.erase(ranks.begin() + 1);
  CHECK(clock.delivery_time(order, ranks).late_ms == Approx(0).margin(1e-9));
  const WorkDeliveryClock without_rate(0, 0);
  CHECK(without_rate.deadline_s(2, 3) == 0);
  CHECK(without_rate.delivery_time(FrameOrder(), ranks).finished_s == Approx(0.1));
  CHECK(without_rate.delivery_time(FrameOrder(), ranks).late_ms == 0);
}

TEST_CASE("a frame is late by what has passed since its deadline, early by what is left") {
  double now = 10;
  WallDeliveryClock clock(4, 1, false, [&now] { return now; });
  clock.begin_sequence(10);
  CHECK(clock.now_s() == 0);
  FrameOrder order;
  order.deadline_s = clock.deadline_s(2, 5);
  CHECK(order.deadline_s == Approx(0.75));  // in real time frames that are left out take none
  now = 10.8;
  CHECK(clock.now_s() == Approx(0.8));
  CHECK(clock.delivery_time(order, {}).finished_s == Approx(0.8));
  CHECK(clock.delivery_time(order, {}).late_ms == Approx(50));
  now = 10.7;
  CHECK(clock.delivery_time(order, {}).late_ms == Approx(-50));
}

TEST_CASE("frames have deadlines with a rate, which are kept unless frames are awaited whole") {
  const auto clock = [](double rate, bool awaits_all) {
    return WallDeliveryClock(rate, 1, awaits_all, [] { return 7.0; });
  };
  const WallDeliveryClock kept = clock(4, false), whole = clock(4, true), none = clock(0, false);
  CHECK((kept.has_deadlines() && kept.keeps_deadlines()));
  CHECK((whole.has_deadlines() && !whole.keeps_deadlines()));
  CHECK((!none.has_deadlines() && !none.keeps_deadlines()));
  CHECK((none.deadline_s(3, 0) == 0 && none.units_per_frame() == 0));
  // Where none are kept nothing keeps the next frame from being prepared.
  CHECK((whole.may_overlap(1) && none.may_overlap(1) && !kept.may_overlap(1)));
  const WorkDeliveryClock work(4, 5'000'000);
  CHECK((!work.has_deadlines() && !work.keeps_deadlines() && !work.may_overlap(1)));
  CHECK((work.units_per_frame() == 5e6 && work.now_s() == 0));
}

TEST_CASE("without a rate a common start that has gone by already is when time begins") {
  double now = 10;
  WallDeliveryClock clock(0, 1, false, [&now] { return now; });
  clock.begin_sequence(9);
  CHECK(clock.now_s() == Approx(1));
}

TEST_CASE("on the work clock a frame of several periods has their budgets") {
  const WorkDeliveryClock clock(4, 5'000'000);
  std::vector<RankReport> ranks(1);
  ranks[0].finished_s = 0.25;
  FrameOrder order;
  order.deadline_s = 2, order.periods = 2;
  CHECK(clock.delivery_time(order, ranks).finished_s == Approx(2 - 2 * 0.25 + 0.25));
  CHECK(clock.delivery_time(order, ranks).late_ms == Approx(1e3 * (0.25 - 2 * 0.1)));
  const WorkDeliveryClock slow(0.5, 5'000'000);  // frames may be seconds apart
  order.periods = 1;
  CHECK(slow.delivery_time(order, ranks).finished_s == Approx(2 - 2 + 0.25));
  CHECK(slow.delivery_time(order, ranks).late_ms == Approx(1e3 * (0.25 - 0.1)));
}

TEST_CASE("clocks are made as the settings say: kind, rate, budget, and slow ranks") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.frames_per_second = 4, settings.budget_units = 5'000'000;
  settings.machine.slow_ranks = 2, settings.machine.slowness = 3;
  const SequenceClock sequence;
  const auto frame_clock = [&](int rank) {
    return make_frame_clock(settings, rank, sequence, 1000, 1, true);
  };
  const auto delivery = [&] { return make_delivery_clock(settings, 2, [] { return 7.0; }); };
  settings.clock = ClockKind::kWork;
  CHECK(is_reproducible(settings));
  for (const int rank : {0, 1, 2, 3}) CHECK(frame_clock(rank)->pace() == (rank < 2 ? 3 : 1));
  CHECK((delivery()->units_per_frame() == 5e6 && delivery()->deadline_s(0, 1) == Approx(0.5)));
  FrameOrder order;
  for (const double rate : {4.0, 0.0}) {
    settings.frames_per_second = rate;
    const auto clock = frame_clock(3);
    clock->begin_frame(order);
    CHECK(clock->sampling_share() == (rate > 0 ? Approx(1.0 / 24) : Approx(0.5)));
    CHECK(clock->affordable(Work::kRay, 1) == (rate > 0 ? 5'000'000 / price(Work::kRay) : 0));
  }
  settings.frames_per_second = 4;
  settings.clock = ClockKind::kWall;
  CHECK_FALSE(is_reproducible(settings));
  for (const int rank : {0, 3}) CHECK(frame_clock(rank)->pace() == 1);  // nothing is known yet
  CHECK((delivery()->keeps_deadlines() && delivery()->deadline_s(0, 1) == Approx(0.25)));
  CHECK((delivery()->now_s() == 7 && delivery()->units_per_frame() == Approx(0.125e9)));
  settings.awaits_all = true;
  CHECK((delivery()->has_deadlines() && !delivery()->keeps_deadlines()));
}

}  // namespace pprt::delivery_clock_test
