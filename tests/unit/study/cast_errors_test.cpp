// Ways of casting judged by true error: which sequences, and what comes out.
#include "study/cast_errors.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "study/paper/runs.h"

using namespace pprt;

namespace {

CastTrial small_trial() {
  CastTrial trial;
  trial.sequences = {{"tree", 1}, {"rings", 0.125}};
  trial.densities = {0.3, 1.5};
  trial.side = 48;
  trial.judged = {2, 3};
  trial.reference_side = 3;
  return trial;
}

}  // namespace

TEST_CASE("the full trial takes four scenes at two speeds and two densities") {
  const CastTrial trial = cast_trial(settled({}));
  CHECK(trial.sequences.size() == 8);
  CHECK(trial.densities.size() == 2);
  CHECK(trial.judged == std::vector{2, 5, 8, 12});
  CHECK(trial.side == 192);
  PaperOptions quick;
  quick.quick = true;
  CHECK(cast_trial(settled(quick)).judged == std::vector{2, 5});
  CHECK(cast_trial(settled(quick)).side < 100);
}

TEST_CASE("errors come for every sequence and density, the same each time, smaller with more samples") {
  int told = 0;
  const CastTrial trial = small_trial();
  const std::vector<CastErrors> errors = run_cast_trial(trial, [&](const std::string&) { ++told; });
  const std::vector<CastErrors> again = run_cast_trial(trial, [](const std::string&) {});
  CHECK(told == 2);
  REQUIRE(errors.size() == 4);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    CAPTURE(errors[i].sequence.scene, errors[i].samples_per_pixel);
    CHECK(errors[i].sequence.scene == (i < 2 ? "tree" : "rings"));
    CHECK(errors[i].rmse == again[i].rmse);
    for (std::size_t way = 0; way < kCastWays.size(); ++way) {
      CHECK(errors[i].rmse[way] > 0.001);
      CHECK(errors[i].rmse[way] < 0.3);
      if (i % 2 == 1) CHECK(errors[i].rmse[way] < errors[i - 1].rmse[way]);
    }
    CHECK(errors[i].rmse[0] != errors[i].rmse[1]);
  }
  const Table table = cast_errors_table(errors);
  CHECK(table.rows.size() == 4);
  CHECK(table.columns.size() == table.rows[0].size());
}

TEST_CASE("small things that were seen in a frame are seen in the next ones too") {
  CastTrial trial = cast_trial(settled({}));
  trial.densities = {0.3};
  trial.judged = {8, 12};
  std::erase_if(trial.sequences, [](const CastSequence& s) { return s.scene != "tree" || s.speed != 1; });
  const std::vector<CastErrors> errors = run_cast_trial(trial, [](const std::string&) {});
  REQUIRE(errors.size() == 1);
  const double off = errors[0].rmse[0], verified = errors[0].rmse[2], with_anchors = errors[0].rmse[3];
  CHECK(with_anchors < 0.95 * off);
  CHECK(with_anchors < 0.95 * verified);
}

TEST_CASE("auto is compared with the best of the others") {
  CHECK(CastErrors{{"tree", 1}, 1, {0.04, 0.02, 0.03, 0.021}}.auto_ratio() == Approx(1.05));
}

TEST_CASE("what a trial throws comes out of it") {
  CastTrial trial = small_trial();
  CHECK_THROWS_AS(run_cast_trial(trial, [](const std::string&) { throw std::runtime_error("full"); }),
                  std::runtime_error);
}
