#include "parallel/master/frame_effort.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "parallel/session.h"
#include "unit/parallel/virtual_run.h"

namespace pprt::frame_effort_test {
namespace {

FrameError measured(double rmse, double deviation_share = 0) {
  FrameError error;
  error.own = {rmse * rmse, std::pow(deviation_share * rmse * rmse, 2), 0};
  return error;
}

// Plays frames whose squared error falls as the 1.3th power of the effort.
double settled_effort(FrameEffort& effort, double rmse_at_full, int frames, Carry carry = Carry::kNothing) {
  FrameOrder order;
  order.carry = carry;
  for (int f = 0; f < frames; ++f) {
    order.effort = effort.for_frame(false, carry == Carry::kAccumulate);
    effort.learn(order, measured(rmse_at_full * std::pow(order.effort, -0.65)));
  }
  return effort.for_frame(false, carry == Carry::kAccumulate);
}

}  // namespace

TEST_CASE("effort: as much as makes frames good enough, all where nothing is asked or known") {
  FrameEffort none(0);
  CHECK(settled_effort(none, 0.01, 30) == 1);
  FrameEffort half(0.02);
  CHECK(half.for_frame(false, false) == 1);
  CHECK(settled_effort(half, 0.01, 30) == Approx(std::pow(2, -1 / 0.65)));
  FrameEffort coarse(0.02);
  CHECK(settled_effort(coarse, 0.03, 30) == 1);
  CHECK(half.for_frame(true, false) == 1);
}

TEST_CASE("effort: what is known roughly counts as worse") {
  FrameEffort sure(0.02), unsure(0.02);
  FrameOrder order;
  for (int f = 0; f < 8; ++f) sure.learn(order, measured(0.012)), unsure.learn(order, measured(0.012, 1.5));
  CHECK(unsure.for_frame(false, false) > 1.2 * sure.for_frame(false, false));
}

TEST_CASE("effort: a resting picture that is good enough gets no more samples") {
  FrameEffort effort(0.02);
  CHECK(settled_effort(effort, 0.03, 5, Carry::kAccumulate) == 1);
  FrameEffort fine(0.02);
  FrameOrder order;
  order.carry = Carry::kAccumulate;
  fine.learn(order, measured(0.01));
  CHECK(fine.for_frame(false, true) == 1);
  fine.learn(order, measured(0.01));
  CHECK(fine.for_frame(false, true) == 0);
}

TEST_CASE("effort: frames at a rate end early, and keep the RMSE that is asked for") {
  SessionSettings settings{.sampler = SamplerChoice::kAuto};
  settings.width = 192, settings.height = 128;
  settings.clock = ClockKind::kWork;
  settings.frames_per_second = 4;
  settings.budget_units = 40'000'000;
  settings.measures_error = true;
  Conditions conditions;
  conditions.period = 2.3;
  const auto samples_of_last = [&](double rmse) {
    settings.stop.rmse = rmse;
    const VirtualRun run = run_session(2, settings, still_or_pan(settings, 16, 3.5), conditions);
    REQUIRE(run.error.empty());
    REQUIRE(run.frames.size() == 16);
    double samples = 0;
    for (const RankReport& r : run.frames.back().ranks) samples += static_cast<double>(r.samples_new);
    return std::pair(samples, run.frames.back().order.effort);
  };
  const auto [all, full] = samples_of_last(0);
  const auto [few, effort] = samples_of_last(0.05);
  CHECK(full == 1);
  CHECK(effort < 0.8);
  CHECK(few < 0.9 * all);
  CHECK(few > 0.3 * effort * all);
}

}  // namespace pprt::frame_effort_test
