#include "render/records/progress.h"

#include <catch2/catch.hpp>

namespace pprt::progress_test {
namespace {

Pace::Time at(double seconds) {
  return Pace::Time(std::chrono::duration_cast<Pace::Time::duration>(std::chrono::duration<double>(seconds)));
}

}  // namespace

TEST_CASE("the pace is the mean rate of the frames after the first") {
  Pace pace(at(10));
  CHECK(pace.frames_per_second() == 0);
  CHECK(pace.seconds_for(5) == 0);
  pace.frame(at(12));  // there is no other to measure from
  CHECK(pace.frames_per_second() == Approx(0.5));
  CHECK(pace.seconds_for(5) == Approx(10));
  pace.frame(at(12.25));
  CHECK(pace.frames_per_second() == Approx(4));
  pace.frame(at(13));  // two in a second
  CHECK(pace.frames_per_second() == Approx(2));
  CHECK(pace.seconds_for(5) == Approx(2.5));
  CHECK(pace.seconds_for(0) == 0);
}

TEST_CASE("the time left is the rest of the frame at hand, and further frames at the pace or like this one") {
  Pace pace(at(0));
  CHECK(seconds_left(3, 0.25, 0, pace) == Approx(9));
  CHECK(seconds_left(3, 0.25, 2, pace) == Approx(9 + 24));
  CHECK(seconds_left(3, 1, 0, pace) == 0);
  pace.frame(at(5));
  CHECK(seconds_left(3, 0.25, 2, pace) == Approx(9 + 10));
}

TEST_CASE("frames that come at the same time have no pace") {
  Pace pace(at(1));
  pace.frame(at(1));
  pace.frame(at(1));
  CHECK(pace.frames_per_second() == 0);
  CHECK(pace.seconds_for(3) == 0);
}

TEST_CASE("the time left has minutes and seconds, from an hour on with hours") {
  CHECK(minutes(0.4) == "0:00");
  CHECK(minutes(75.2) == "1:15");
  CHECK(minutes(3599.4) == "59:59");
  CHECK(minutes(3599.6) == "1:00:00");
  CHECK(minutes(3600 + 15 * 60 + 2) == "1:15:02");
  CHECK(minutes(25 * 3600 + 59) == "25:00:59");
}

}  // namespace pprt::progress_test
