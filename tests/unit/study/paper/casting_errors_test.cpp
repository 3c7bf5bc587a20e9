// The trial of the ways of casting: its sequences and its errors.
#include "study/paper/casting_errors.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace pprt::casting_errors_test {

namespace {

CastingTrial small_trial() {
  CastingTrial trial;
  trial.sequences = {{"tree", 1}, {"rings", 0.125}};
  trial.densities = {0.3, 1.5};
  trial.side = 48;
  trial.judged = {2, 3};
  trial.reference_side = 3;
  return trial;
}

}  // namespace

TEST_CASE("casting trial: four scenes at two speeds and two densities") {
  const CastingTrial trial = casting_trial(settled({}));
  CHECK(trial.sequences.size() == 8);
  CHECK(trial.densities.size() == 2);
  CHECK(trial.judged == std::vector{2, 5, 8, 12});
  CHECK(trial.side == 192);
  PaperOptions quick;
  quick.quick = true;
  CHECK(casting_trial(settled(quick)).judged == std::vector{2, 5});
  CHECK(casting_trial(settled(quick)).side < 100);
}

TEST_CASE("casting trial: every sequence and density has errors, which repeat and fall with more samples") {
  int reports = 0;
  const CastingTrial trial = small_trial();
  const std::vector<CastingErrors> errors = run_casting_trial(trial, [&](const std::string&) { ++reports; });
  const std::vector<CastingErrors> again = run_casting_trial(trial, [](const std::string&) {});
  CHECK(reports == 2);
  REQUIRE(errors.size() == 4);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    CAPTURE(errors[i].sequence.scene, errors[i].samples_per_pixel);
    CHECK(errors[i].sequence.scene == (i < 2 ? "tree" : "rings"));
    CHECK(errors[i].rmse == again[i].rmse);
    for (std::size_t cast = 0; cast < kWords<CastChoice>.size(); ++cast) {
      CHECK(errors[i].rmse[cast] > 0.001);
      CHECK(errors[i].rmse[cast] < 0.3);
      if (i % 2 == 1) CHECK(errors[i].rmse[cast] < errors[i - 1].rmse[cast]);
    }
    CHECK(errors[i].rmse[0] != errors[i].rmse[1]);
  }
  const Table table = casting_errors_table(errors);
  CHECK(table.rows.size() == 4);
  CHECK(table.columns.size() == table.rows[0].size());
}

TEST_CASE("casting trial: auto casting keeps small objects that earlier frames have seen") {
  CastingTrial trial = casting_trial(settled({}));
  trial.densities = {0.3};
  trial.judged = {8, 12};
  std::erase_if(trial.sequences, [](const TurnSequence& s) { return s.scene != "tree" || s.speed != 1; });
  const std::vector<CastingErrors> errors = run_casting_trial(trial, [](const std::string&) {});
  REQUIRE(errors.size() == 1);
  const double off = errors[0].rmse[0], verified = errors[0].rmse[2], with_anchors = errors[0].rmse[3];
  CHECK(with_anchors < 0.95 * off);
  CHECK(with_anchors < 0.95 * verified);
}

TEST_CASE("casting trial: other weights and another seed make other errors") {
  PaperOptions options;
  options.quick = true;
  CastingTrial trial = casting_trial(settled(options));
  trial.densities = {0.3}, trial.judged = {2};
  std::erase_if(trial.sequences, [](const TurnSequence& s) { return s.scene != "tree" || s.speed != 1; });
  const auto errors = [&] { return run_casting_trial(trial, [](const std::string&) {}).at(0).rmse; };
  const auto plain = errors();
  trial.weights = WeightRule::kLearned;
  CHECK(errors() != plain);
  trial.weights = WeightRule::kPaper, trial.seed = 2;
  CHECK(errors() != plain);
}

TEST_CASE("casting trial: auto is compared with the best of the other ways") {
  CHECK(CastingErrors{{"tree", 1}, 1, {0.04, 0.02, 0.03, 0.021}}.auto_ratio() == Approx(1.05));
}

TEST_CASE("casting trial: an exception of the progress report reaches the caller") {
  CastingTrial trial = small_trial();
  CHECK_THROWS_AS(run_casting_trial(trial, [](const std::string&) { throw std::runtime_error("full"); }),
                  std::runtime_error);
}

}  // namespace pprt::casting_errors_test
