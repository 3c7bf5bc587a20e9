#include "parallel/clock/stage_timer.h"

#include <catch2/catch.hpp>

#include "unit/parallel/clock/set_clock.h"

namespace pprt::stage_timer_test {
namespace {

// Every reading of this clock is a millisecond after the one before.
constexpr double kNow = 0;

TEST_CASE("stage timer: each stage gets the time since the one before it ended") {
  SetClock clock(1, 1, kNow);
  StageTimer timer(clock);
  timer.begin_frame();
  timer.start();
  CHECK(timer.end_stage(&StageTimes::casting) == Approx(1));
  clock.used_ns();
  CHECK(timer.end_stage(&StageTimes::sampling) == Approx(2));
  CHECK(timer.end_stage(&StageTimes::sampling) == Approx(1));
  CHECK(timer.times().casting == Approx(1));
  CHECK(timer.times().sampling == Approx(3));
  CHECK(timer.times().balancing == 0);
}

TEST_CASE("stage timer: balancing is taken out of the stage that it interrupts, and of no other") {
  SetClock clock(1, 1, kNow);
  StageTimer timer(clock);
  timer.begin_frame();
  timer.start();
  for (int i = 0; i < 2; ++i) const StageTimer::Balancing timed(timer);
  CHECK(timer.times().balancing == Approx(2));
  CHECK(timer.end_stage(&StageTimes::sampling) == Approx(5 - 2));
  CHECK(timer.end_stage(&StageTimes::reconstruction) == Approx(1));
}

TEST_CASE("stage timer: a frame begins with nothing, whatever was charged before its start") {
  SetClock clock(1, 1, kNow);
  StageTimer timer(clock);
  timer.start();
  timer.end_stage(&StageTimes::sampling);
  timer.begin_frame();
  CHECK(timer.times().sampling == 0);
  { const StageTimer::Balancing timed(timer); }  // a late rank takes over a partition
  timer.start();
  CHECK(timer.end_stage(&StageTimes::sampling) == Approx(1));
}

}  // namespace
}  // namespace pprt::stage_timer_test
