#include "cli/process/run_watch.h"

#include <catch2/catch.hpp>
#include <csignal>

namespace pprt::run_watch_test {
namespace {

RankNews news(RankEvent event, int rank, int number = 0) {
  return {.event = event, .rank = rank, .number = number, .host = "vm"};
}

// A run of three ranks whose guards have spoken at 0 s.
RunWatch three_ranks(bool goes_on) {
  RunWatch watch({.goes_on = goes_on});
  for (const int rank : {0, 1, 2}) watch.hear(news(RankEvent::kLives, rank, 1), 0);
  return watch;
}

void all_live(RunWatch& watch, double now_s) {
  for (const int rank : {0, 1, 2}) watch.hear(news(RankEvent::kLives, rank, 1), now_s);
}

}  // namespace

TEST_CASE("a run that goes on ends at once for want of rank 0, or of any before the first frame") {
  RunWatch starting = three_ranks(true);
  starting.hear(news(RankEvent::kKilled, 2, SIGKILL), 1);
  CHECK(starting.failure(1) == "rank 2 on vm was ended by signal 9 (Killed)");

  RunWatch watch = three_ranks(true);
  watch.hear(news(RankEvent::kMet, 0), 1);
  watch.hear(news(RankEvent::kSpares, 0), 1);
  watch.hear(news(RankEvent::kKilled, 2, SIGKILL), 2);
  CHECK_FALSE(watch.failure(2));
  CHECK_FALSE(watch.loss());
  watch.hear(news(RankEvent::kKilled, 0, SIGSEGV), 3);
  CHECK(watch.failure(3) == "rank 0 on vm was ended by signal 11 (Segmentation fault)");
}

TEST_CASE("a run that does not go on is left to mpirun for a while, and the first loss is its reason") {
  RunWatch watch = three_ranks(false);
  watch.hear(news(RankEvent::kKilled, 1, SIGKILL), 1);
  watch.hear(news(RankEvent::kKilled, 2, SIGTERM), 1);
  CHECK(watch.loss() == "rank 1 on vm was ended by signal 9 (Killed)");
  CHECK_FALSE(watch.failure(5));
  all_live(watch, 11);
  CHECK(watch.failure(11.1) == watch.loss());
}

TEST_CASE("a rank that was stopped ends a run that waits for it, unless it goes on in time") {
  for (const int rank : {0, 2}) {
    RunWatch watch = three_ranks(false);
    watch.hear(news(RankEvent::kStopped, rank, SIGSTOP), 1);
    all_live(watch, 9);
    CHECK_FALSE(watch.failure(9));
    CHECK(watch.failure(9.1) ==
          "rank " + std::to_string(rank) +
              " on vm was stopped by signal 19 (Stopped (signal)) and has not gone on for 8 s");
    watch.hear(news(RankEvent::kContinued, rank), 9.2);
    CHECK_FALSE(watch.failure(9.3));
  }
  RunWatch sparing = three_ranks(false);
  sparing.hear(news(RankEvent::kSpares, 0), 1);
  sparing.hear(news(RankEvent::kStopped, 2, SIGSTOP), 1);
  sparing.hear(news(RankEvent::kLives, 0, 1), 50);
  CHECK_FALSE(sparing.failure(50));
}

TEST_CASE("a guard that keeps silent ends a run, but not one whose rank has ended by itself") {
  RunWatch watch = three_ranks(false);
  watch.hear(news(RankEvent::kLeft, 1), 1);
  watch.hear(news(RankEvent::kLives, 3, 0), 1);  // on another host, whence nothing comes regularly
  watch.hear(news(RankEvent::kLives, 0, 1), 9);
  CHECK_FALSE(watch.failure(10));
  CHECK(watch.failure(10.1) == "no sign of rank 2 on vm for 10 s");
  watch.hear(news(RankEvent::kLeft, 2), 10.2);
  watch.hear(news(RankEvent::kLives, 0, 1), 100);
  CHECK_FALSE(watch.failure(100));
}

TEST_CASE("a rank that is not heard at all ends a run, unless all have met") {
  for (const bool goes_on : {false, true}) {
    for (const int missing : {0, 2}) {
      CAPTURE(goes_on, missing);
      const auto heard = [&](double now_s) {
        RunWatch watch({.goes_on = goes_on, .ranks = 3});
        CHECK_FALSE(watch.failure(50));  // mpirun itself takes its time
        for (const int rank : {0, 1, 2})
          if (rank != missing) watch.hear(news(RankEvent::kLives, rank, 0), now_s);
        return watch;
      };
      RunWatch watch = heard(3);
      CHECK_FALSE(watch.failure(13));
      CHECK(watch.failure(13.1) == "no sign of rank " + std::to_string(missing) + " for 10 s");
      watch.hear(news(RankEvent::kLives, missing, 0), 13.2);
      CHECK_FALSE(watch.failure(14));
      RunWatch met = heard(3);
      met.hear(news(RankEvent::kMet, 1), 4);
      CHECK_FALSE(met.failure(50));
    }
  }
  // As many as come.
  RunWatch any({});
  any.hear(news(RankEvent::kLives, 2, 0), 0);
  CHECK_FALSE(any.failure(50));
}

TEST_CASE("an mpirun that was stopped is given time to go on, and nothing is expected of ranks meanwhile") {
  RunWatch watch = three_ranks(false);
  watch.see_mpirun(true, 5);
  watch.see_mpirun(true, 12);
  CHECK_FALSE(watch.failure(12));
  CHECK(watch.failure(13.1) == "mpirun was stopped by a signal and has not gone on for 8 s");
  watch.see_mpirun(false, 13.2);
  all_live(watch, 13.2);
  CHECK_FALSE(watch.failure(13.3));
}

TEST_CASE("a run that has told its end cannot fail any more, and mpirun's time ends") {
  RunWatch watch = three_ranks(false);
  watch.hear(news(RankEvent::kEnded, 0, 130), 5);
  CHECK(watch.end_code() == 130);
  CHECK_FALSE(watch.failure(100));
  CHECK_FALSE(watch.is_over(13));
  CHECK(watch.is_over(13.1));
  watch.hear(news(RankEvent::kLeft, 0), 6);
  CHECK_FALSE(watch.is_over(8));
  CHECK(watch.is_over(8.1));
}

}  // namespace pprt::run_watch_test
