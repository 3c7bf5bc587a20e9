#include "render/records/advice.h"

#include <catch2/catch.hpp>

namespace pprt::advice_test {
namespace {

// Two ranks on two cores, all on time, and fine.
constexpr RunFigures kSound{.frames_per_second = 60,
                            .frames = 100,
                            .late = 0,
                            .late_p95_ms = -2,
                            .least_rmse = 0.01,
                            .samples_per_pixel = 0.5,
                            .width = 256,
                            .height = 256,
                            .ranks = 2,
                            .cores = 2};

RunFigures late(int frames, double late_p95_ms) {
  RunFigures run = kSound;
  run.late = frames, run.late_p95_ms = late_p95_ms;
  return run;
}

}  // namespace

TEST_CASE("advice: none for a run that is on time and fine, nor for one without a rate") {
  CHECK(advice_on(kSound).empty());
  CHECK(advice_on(late(5, 1)).empty());
  RunFigures still = late(50, 5);
  still.frames_per_second = 0;
  CHECK(advice_on(still).empty());
  RunFigures brief = late(2, 5);  // of four: chance
  brief.frames = 4;
  CHECK(advice_on(brief).empty());
}

TEST_CASE("advice: a rate that the measured lateness would have kept") {
  CHECK(advice_on(late(12, 4)) ==
        "12 of 100 frames were late; 95 % of them would not have been at --fps 48; "
        "all cores were used; more hosts (--hostfile) help");
}

TEST_CASE(
    "advice: half the rate or half the pixels where the measured error is large, and cores that are idle") {
  RunFigures coarse = kSound;
  coarse.least_rmse = 0.05, coarse.samples_per_pixel = 0.11, coarse.cores = 8;
  CHECK(advice_on(coarse) ==
        "0.11 samples a pixel are few; --fps 30 or --size 181x181 gives twice as many; "
        "2 of 8 cores were used; --threads auto uses all");
  coarse.ranks = 9, coarse.frames_per_second = 5;
  CHECK(advice_on(coarse) ==
        "0.11 samples a pixel are few; --fps 2.5 or --size 181x181 gives twice as many; "
        "9 ranks share 8 cores of this host; more hosts (--hostfile) or fewer ranks help");
}

TEST_CASE("advice: on the page its own controls, of which a run with files fixes the size") {
  CHECK(advice_on(late(12, 4), Remedies::kPage) ==
        "12 of 100 frames were late; 95 % of them would not have been at a Rate of 48 frames/s; "
        "all cores were used; more hosts (--hostfile) help");
  RunFigures coarse = kSound;
  coarse.least_rmse = 0.05, coarse.frames_per_second = 5;
  CHECK(advice_on(coarse, Remedies::kPage) ==
        "0.5 samples a pixel are few; a Rate of 2 frames/s or a Size of half as many pixels gives twice as "
        "many; all cores were used; more hosts (--hostfile) help");
  CHECK(advice_on(coarse, Remedies::kPageOfFixedSize) ==
        "0.5 samples a pixel are few; a Rate of 2 frames/s gives twice as many; "
        "all cores were used; more hosts (--hostfile) help");
  coarse.frames_per_second = 1;  // the page has no lower one
  CHECK(advice_on(coarse, Remedies::kPageOfFixedSize) ==
        "0.5 samples a pixel are few; all cores were used; more hosts (--hostfile) help");
}

}  // namespace pprt::advice_test
