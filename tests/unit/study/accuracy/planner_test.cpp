// The planner's sentences, from made-up measurements.
#include "study/accuracy/planner.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

namespace pprt::planner_test {

namespace {

std::vector<RatePoint> error_with_root_of_rate() {
  std::vector<RatePoint> points;
  for (const double fps : {1.0, 4.0, 16.0}) {
    points.push_back({.scene = "s", .cast = CastChoice::kAuto, .fps = fps, .rmse = 0.01 * std::sqrt(fps)});
  }
  return points;
}

}  // namespace

TEST_CASE("planner: names the error at a rate") {
  const std::vector<RatePoint> points = error_with_root_of_rate();
  CHECK(error_at_rate(points, 4) == "s: at 4 frames/s the RMSE will be about 0.0200.");
  CHECK(error_at_rate(points, 9) == "s: at 9 frames/s the RMSE will be about 0.0300.");
  CHECK(error_at_rate(points, 99) == "s: above 16 frames/s the RMSE will be 0.0400 or more.");
  CHECK(error_at_rate(points, 0.5) == "s: below 1 frames/s the RMSE will be 0.0100 or less.");
  CHECK(error_at_rate({points[1]}, 4) == "s: at 4 frames/s the RMSE will be about 0.0200.");
  CHECK_THROWS_AS(error_at_rate({}, 4), std::invalid_argument);
}

TEST_CASE("planner: names the rate that has an error") {
  const std::vector<RatePoint> points = error_with_root_of_rate();
  CHECK(rate_with_error(points, 0.03) == "s: an RMSE of 0.03 can be had at about 9 frames/s.");
  CHECK(rate_with_error(points, 0.001) ==
        "s: an RMSE of 0.001 needs less than 1 frames/s, at which it is 0.0100.");
  CHECK(rate_with_error({points[1]}, 0.001) ==
        "s: an RMSE of 0.001 needs less than 4 frames/s, at which it is 0.0200.");
  CHECK(rate_with_error(points, 0.5) == "s: an RMSE of 0.5 is kept at 16 frames/s and more.");
  CHECK_THROWS_AS(rate_with_error({}, 0.5), std::invalid_argument);
}

TEST_CASE("planner: tells what is seen at a rate, beside others") {
  const std::vector<RateResult> results = {{.fps = 24, .held = {0.05, 0.06}},
                                           {.fps = 12, .held = {0.07, 0.08}},
                                           {.fps = 48, .held = {0.04125, 0.055}}};
  CHECK(seen_at_rates("s", results) ==
        "s: a viewer sees each frame until the next is delivered; over time the RMSE is then 0.0500 and the "
        "FLIP 0.0600 at 24 frames/s; 0.0700 and 0.0800 at 12, 0.0413 and 0.0550 at 48.");
  CHECK(seen_at_rates("s", std::span(results).first(1)) ==
        "s: a viewer sees each frame until the next is delivered; over time the RMSE is then 0.0500 and the "
        "FLIP 0.0600 at 24 frames/s.");
  CHECK_THROWS_AS(seen_at_rates("s", {}), std::invalid_argument);
}

TEST_CASE("planner: summarises real time by medians over the turns") {
  std::vector<RealTimeTurn> turns(3);
  for (RealTimeTurn& turn : turns) {
    turn.with.scene = "tree", turn.with.ranks = 2, turn.with.frames = 80, turn.with.on_time = 1;
    turn.with.late_max_ms = -0.5, turn.with.fewest_samples = 19'500;
    turn.without.errors.rmse = 0.025;
    turn.with.errors.flip = 0.03, turn.uniform.flip = 0.04;
  }
  turns[1].with.on_time = 0.9875, turns[1].with.late_max_ms = 1.25, turns[1].with.fewest_samples = 18'900;
  // A turn in which all were slower, and one in which casting had bad luck: ratios .8, .7 and 1.
  turns[0].with.errors.rmse = 0.04, turns[0].without.errors.rmse = 0.05;
  turns[1].with.errors.rmse = 0.0175;
  turns[2].with.errors.rmse = 0.025;
  // .4, .35, .625
  turns[0].uniform.rmse = 0.1, turns[1].uniform.rmse = 0.05, turns[2].uniform.rmse = 0.04;
  CHECK(
      real_time_summary(turns) ==
      "tree: in real time 239 of 240 frames were on time on 2 ranks, the latest 1.2 ms late; no frame after "
      "the fifth had fewer than 18900 samples. RMSE 0.0250: 0.80 (0.70 to 1.00 by turns) of that without "
      "casting and 0.40 of that of uniform sampling in all of their time. FLIP 0.0300: 0.75 of uniform "
      "sampling's.");
  CHECK_THROWS_AS(real_time_summary({}), std::invalid_argument);
}

}  // namespace pprt::planner_test
