#include "parallel/clock/delivery_clock.h"

#include <catch2/catch.hpp>

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

}  // namespace pprt::delivery_clock_test
