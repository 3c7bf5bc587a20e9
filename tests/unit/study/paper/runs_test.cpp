// Which runs the paper's study makes, and what one of them measures.
#include "study/paper/runs.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "study/paper/measures.h"

namespace pprt::runs_test {

namespace {

Calibration even(const std::vector<int>& ranks) {
  Calibration calibration{3e7, {{9, 1.0}}, 0.001};
  for (const int count : ranks) calibration.share[count] = 1;
  return calibration;
}

std::ptrdiff_t count(const std::vector<PaperRun>& runs, std::string_view experiment) {
  return std::count_if(runs.begin(), runs.end(),
                       [&](const PaperRun& run) { return run.experiment == experiment; });
}

}  // namespace

TEST_CASE("paper study: defaults are the paper's, or small ones if quick") {
  CHECK(settled({}).ranks == std::vector{32, 62});
  CHECK(settled({}).frames == 40);
  PaperOptions quick;
  quick.quick = true;
  quick.frames = 8;
  CHECK(settled(quick).ranks == std::vector{4, 6});
  CHECK(settled(quick).frames == 8);
}

TEST_CASE("paper study: a machine's network can be set apart from its processors") {
  PaperOptions options;
  options.machine = MachineKind::kSp2;
  CHECK(machine_of(options).bytes_per_second == sp2_machine().bytes_per_second);
  options.latency_us = 7;
  options.bandwidth_mb_s = 100;
  CHECK(machine_of(options).latency_s == Approx(7e-6));
  CHECK(machine_of(options).bytes_per_second == Approx(1e8));
  CHECK(machine_of(options).units_per_second == sp2_machine().units_per_second);
}

TEST_CASE("paper study: each experiment of the paper has its runs") {
  const PaperOptions options = settled({});
  const std::vector<PaperRun> runs = paper_runs(options, even(options.ranks));
  CHECK(count(runs, kSimple) == 8);   // four modes, two numbers of ranks
  CHECK(count(runs, kCasting) == 4);  // three modes, and samples kept
  // Seven numbers of ranks: three modes, and a larger picture; four on a still larger one.
  CHECK(count(runs, kScaling) == 28 + 4);
  CHECK(count(runs, kShortFrame) == 14 + 4);
  CHECK(count(runs, kCosts) == 7);
  for (const PaperRun& run : runs) {
    if (run.experiment == kSimple) CHECK((run.cast == CastChoice::kOff && run.frames == 40));
    if (run.experiment == kCasting) CHECK((run.cast == CastChoice::kPaper && run.ranks == 62));
    if (run.experiment == kScaling) CHECK(run.share == 1);
  }
}

TEST_CASE("paper study: as many ranks as are asked for have regions of one size") {
  PaperOptions options = settled({});
  const auto greatest = [&] {
    int ranks = 0;
    for (const PaperRun& run : paper_runs(options, even(options.ranks))) {
      if (run.experiment == kScaling) ranks = std::max(ranks, run.ranks);
    }
    return ranks;
  };
  CHECK(greatest() == 256);
  options.most_ranks = 1024;
  CHECK(greatest() == 1024);
  options.most_ranks = 64;
  CHECK(greatest() == 64);
}

TEST_CASE("paper study: seed and weights are those of every run") {
  PaperOptions options = settled({});
  for (const WeightRule rule : {WeightRule::kLearned, WeightRule::kPaper}) {
    options.seed = 7, options.weights = rule;
    for (const PaperRun& run : paper_runs(options, even(options.ranks))) {
      const SessionSettings settings = settings_of_run(run, 3e7, options);
      CHECK((settings.seed == 7 && weight_rule(settings) == rule));
    }
    CHECK((casting_trial(options).seed == 7 && casting_trial(options).weights == rule));
  }
}

TEST_CASE("paper study: a quick study measures every frame of every run") {
  PaperOptions options;
  options.quick = true;
  options.ranks = {2};
  options.frames = 5;
  options = settled(options);
  std::vector<std::string> reports;
  const PaperResults results =
      run_experiments(options, [&](const std::string& run) { reports.push_back(run); });
  CHECK(reports.size() == results.runs.size());
  CHECK(results.calibration.share.at(2) == 1);
  std::size_t rows = 0;
  for (const MeasuredRun& r : results.runs) {
    CAPTURE(r.experiment, r.ranks);
    CHECK(r.frames.size() == 5);
    rows += r.frames.size();
    for (const FrameMeasures& m : r.frames) {
      CHECK(m.samples > 100);
      CHECK(m.mean_weight > 0);
      CHECK(std::isnan(m.distance) != r.compare_serial);
    }
  }
  CHECK(frames_table(results).rows.size() == rows);

  const Runs runs(results);
  // As many a pixel as 19,000 on 256 x 256 are 2672 on 96 x 96; calibrated within 5 %.
  CHECK(mean(runs.find(kSimple, 2, BalanceMode::kCombined), {4, 5}, &FrameMeasures::samples) ==
        Approx(2672).epsilon(0.05));
  CHECK(mean(runs.find(kScaling, 1, BalanceMode::kNone), {1, 5}, &FrameMeasures::distance) == 0);
  CHECK(mean(runs.find(kSimple, 2, BalanceMode::kNone), {1, 5}, &FrameMeasures::distance) > 0.01);
  // Three views each of frame 1 of the simple sequence, and of 1 and 5 of the casting one; one rank's pattern
  // in four, nine ranks' in one and two.
  CHECK(results.pattern_pictures.size() == 7);
  CHECK(results.sequence_pictures.size() == 9);
}

}  // namespace pprt::runs_test
