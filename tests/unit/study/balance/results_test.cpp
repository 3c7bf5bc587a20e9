#include "study/balance/results.h"

#include <catch2/catch.hpp>

namespace pprt::results_test {
namespace {

std::vector<TraceResult> some_results() {
  const auto frame = [](int number, double deviation, bool repartitioned, int moved, int given) {
    return FrameFigures{.frame = number,
                        .owners = {},
                        .repartitioned = repartitioned,
                        .moved = moved,
                        .given = given,
                        .deviation = deviation,
                        .worst = 1 + deviation};
  };
  return {{"a", BalanceMode::kLocal, {frame(1, 0.5, false, 2, 3), frame(2, 0.25, false, 0, 4)}},
          {"b", BalanceMode::kGlobal, {frame(1, 0.125, true, 8, 0)}}};
}

}  // namespace

TEST_CASE("balance study: tables have a row for each frame and for each trace") {
  CHECK(to_csv(frames_table(some_results())) ==
        "trace,balance,frame,deviation,max_over_mean,tiles_moved,tiles_given,repartitioned\n"
        "a,local,1,0.5,1.5,2,3,0\na,local,2,0.25,1.25,0,4,0\nb,global,1,0.125,1.125,8,0,1\n");
  CHECK(to_csv(traces_table(some_results())) ==
        "trace,balance,frames,deviation,max_over_mean,tiles_moved,tiles_given,repartitions\n"
        "a,local,2,0.375,1.375,2,7,0\nb,global,1,0.125,1.125,8,0,1\n");
}

TEST_CASE("balance study: deviations stand side by side, and a frame that a trace lacks is left open") {
  CHECK(to_csv(deviations_table(some_results())) == "frame,a,b\n1,0.5,0.125\n2,0.25,\n");
  CHECK(aligned(deviations_table(some_results())) ==
        "frame      a      b\n"
        "1      0.500  0.125\n"
        "2      0.250      –\n");
}

TEST_CASE("balance study: the table for programs is a JSON object a line") {
  CHECK(
      json_lines(traces_table(some_results()), "trace") ==
      R"({"record":"trace","trace":"a","balance":"local","frames":2,"deviation":0.375,"max_over_mean":1.375,)"
      R"("tiles_moved":2,"tiles_given":7,"repartitions":0})"
      "\n"
      R"({"record":"trace","trace":"b","balance":"global","frames":1,"deviation":0.125,"max_over_mean":1.125,)"
      R"("tiles_moved":8,"tiles_given":0,"repartitions":1})"
      "\n");
}

}  // namespace pprt::results_test
