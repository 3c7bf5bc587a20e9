#include "study/balance/results.h"

#include <catch2/catch.hpp>

#include "base/diagnostics.h"
#include "study/word_list.h"

namespace pprt {
namespace {

std::vector<PolicyResult> some_results() {
  const auto round = [](int frame, double deviation, bool repartitioned, int moved, int differing) {
    return ReplayedRound{.frame = frame,
                         .owners = {},
                         .repartitioned = repartitioned,
                         .moved = moved,
                         .deviation = deviation,
                         .worst = 1 + deviation,
                         .differing = differing};
  };
  return {{BalanceMode::kNone, {round(1, 0.5, false, 0, 3), round(2, 0.25, false, 0, 4)}},
          {BalanceMode::kGlobal, {round(1, 0.125, true, 8, 0)}}};
}

}  // namespace

TEST_CASE("balance study: tables have a row for each round and for each policy") {
  CHECK(to_csv(rounds_table(some_results())) ==
        "policy,frame,deviation,max_over_mean,tiles_moved,repartitioned,tiles_differing\n"
        "none,1,0.5,1.5,0,0,3\nnone,2,0.25,1.25,0,0,4\nglobal,1,0.125,1.125,8,1,0\n");
  CHECK(to_csv(policies_table(some_results())) ==
        "policy,deviation,max_over_mean,tiles_moved,repartitions,tiles_differing\n"
        "none,0.375,1.375,0,0,7\nglobal,0.125,1.125,8,1,0\n");
}

TEST_CASE("balance study: the table for people is aligned, that for programs a JSON object a line") {
  const Table table = policies_table(some_results());
  CHECK(aligned(table) ==
        "policy  deviation  max_over_mean  tiles_moved  repartitions  tiles_differing\n"
        "none        0.375          1.375            0             0                7\n"
        "global      0.125          1.125            8             1                0\n");
  CHECK(json_lines(table, "policy") ==
        R"({"record":"policy","policy":"none","deviation":0.375,"max_over_mean":1.375,"tiles_moved":0,)"
        R"("repartitions":0,"tiles_differing":7})"
        "\n"
        R"({"record":"policy","policy":"global","deviation":0.125,"max_over_mean":1.125,"tiles_moved":8,)"
        R"("repartitions":1,"tiles_differing":0})"
        "\n");
}

TEST_CASE("word lists: in the order given, and an unknown word is refused by the option's name") {
  constexpr std::string_view kKnown[] = {"red", "green"};
  CHECK(words_in_list("--hue", "green,red", kKnown) == std::vector<std::string_view>{"green", "red"});
  CHECK_THROWS_WITH(words_in_list("--hue", "red,gren", kKnown),
                    "--hue red,gren: 'gren' is none of red, green; did you mean 'green'?");
  CHECK_THROWS_AS(words_in_list("--hue", "red,", kKnown), UsageError);
}

}  // namespace pprt
