// The paper's findings, judged on made-up measures: each criterion both met and missed.
#include "study/paper/findings.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "study/paper/measures.h"

namespace pprt::findings_test {

namespace {

using Change = std::function<void(FrameMeasures&)>;

void add(PaperResults& results, PaperRun run, int frames, const Change& change = {}) {
  MeasuredRun measured{run};
  for (int frame = 1; frame <= frames; ++frame) {
    FrameMeasures m;
    m.number = frame;
    m.mean_weight = 1;
    m.samples = 19'000;
    if (change) change(m);
    measured.frames.push_back(m);
  }
  results.runs.push_back(measured);
}

PaperRun run_of(std::string_view experiment, int ranks, BalanceMode mode) {
  PaperRun run;
  run.experiment = experiment, run.ranks = ranks, run.balance = mode;
  return run;
}

// Deviation and distance as the paper found them on 32 ranks, in the manner of its figure 5.
PaperResults as_in_the_paper() {
  PaperResults results;
  add(results, run_of(kSimple, 32, BalanceMode::kNone), 40, [](FrameMeasures& m) {
    m.mean_weight_deviation = 1.2, m.distance = 0.42, m.border_density = 0.7, m.samples = 20'000;
  });
  add(results, run_of(kSimple, 32, BalanceMode::kLocal), 40, [](FrameMeasures& m) {
    m.mean_weight_deviation = m.number % 30 <= 8 ? 0.8 : 0.3, m.distance = 0.2, m.border_density = 1;
  });
  add(results, run_of(kSimple, 32, BalanceMode::kGlobal), 40, [](FrameMeasures& m) {
    m.mean_weight_deviation = m.number == 31 || m.number == 32 ? 1.4 : 0.1, m.distance = 0.09,
    m.border_density = 1;
    m.repartitioned = true;
  });
  add(results, run_of(kSimple, 32, BalanceMode::kCombined), 40, [](FrameMeasures& m) {
    const bool unsettled = m.number <= 2 || m.number == 31 || m.number == 32;
    m.mean_weight_deviation = unsettled ? 0.9 : 0.15, m.distance = 0.095, m.border_density = 1.02;
    m.repartitioned = unsettled;
  });
  return results;
}

const Finding& find(const std::vector<Finding>& all, std::string_view claim) {
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const Finding& f) { return f.claim.compare(0, claim.size(), claim) == 0; });
  if (found == all.end()) throw std::runtime_error("no finding: " + std::string(claim));
  return *found;
}

std::optional<bool> verdict(const PaperResults& results, const std::string& claim) {
  return find(findings(results), claim).holds();
}

// The same results with one run's frames changed.
PaperResults with(PaperResults results, std::string_view experiment, BalanceMode mode, const Change& change) {
  for (MeasuredRun& r : results.runs) {
    if (r.experiment != experiment || r.balance != mode) continue;
    std::for_each(r.frames.begin(), r.frames.end(), change);
  }
  return results;
}

}  // namespace

TEST_CASE("findings: those of the paper hold on measures like the paper's") {
  const PaperResults results = as_in_the_paper();
  for (const char* claim :
       {"Any load balancing", "With combined balancing", "Combined settles faster than local at the start",
        "Combined settles faster than local after the camera cut", "Global answers", "Combined is almost",
        "Control", "Without balancing", "Many ranks leave", "No strips"}) {
    CAPTURE(claim);
    CHECK(verdict(results, claim) == std::optional(true));
  }
}

TEST_CASE("findings: one that the measures contradict does not hold") {
  struct Contradiction {
    const char* claim;
    BalanceMode mode;
    Change change;
  };
  const std::vector<Contradiction> contradictions = {
      {"Any load balancing", BalanceMode::kLocal, [](FrameMeasures& m) { m.distance = 0.5; }},
      {"Any load balancing", BalanceMode::kGlobal, [](FrameMeasures& m) { m.mean_weight_deviation = 1.3; }},
      {"With combined balancing", BalanceMode::kCombined,
       [](FrameMeasures& m) { m.mean_weight_deviation = m.number >= 25 && m.number <= 30 ? 0.21 : 0.1; }},
      {"With combined balancing", BalanceMode::kNone,
       [](FrameMeasures& m) { m.mean_weight_deviation = 0.5; }},
      {"Control", BalanceMode::kNone, [](FrameMeasures& m) { m.mean_weight_deviation = 0.2; }},
      {"Control", BalanceMode::kNone, [](FrameMeasures& m) { m.distance = 0.1; }},
      {"Combined settles faster than local at the start", BalanceMode::kLocal,
       [](FrameMeasures& m) { m.mean_weight_deviation = 0.1; }},
      {"Combined settles faster than local after the camera cut", BalanceMode::kCombined,
       [](FrameMeasures& m) { m.mean_weight_deviation = m.number >= 31 && m.number <= 34 ? 0.9 : 0.15; }},
      {"Global answers", BalanceMode::kGlobal, [](FrameMeasures& m) { m.mean_weight_deviation = 0.1; }},
      {"Combined is almost", BalanceMode::kCombined, [](FrameMeasures& m) { m.repartitioned = true; }},
      {"Combined is almost", BalanceMode::kCombined, [](FrameMeasures& m) { m.distance = 0.15; }},
      {"Combined is almost", BalanceMode::kLocal, [](FrameMeasures& m) { m.samples = 25'000; }},
      {"Without balancing", BalanceMode::kNone, [](FrameMeasures& m) { m.samples = 18'000; }},
      {"Many ranks leave", BalanceMode::kCombined, [](FrameMeasures& m) { m.distance = 0.101; }},
      {"Many ranks leave", BalanceMode::kNone, [](FrameMeasures& m) { m.distance = 0.3; }},
      {"No strips", BalanceMode::kCombined, [](FrameMeasures& m) { m.border_density = 0.89; }},
  };
  for (const Contradiction& c : contradictions) {
    CAPTURE(c.claim, c.mode);
    const std::vector<Finding> all = findings(with(as_in_the_paper(), kSimple, c.mode, c.change));
    const Finding& finding = find(all, c.claim);
    CHECK(finding.holds() == std::optional(false));
    CHECK(std::all_of(all.begin(), all.end(), [](const Finding& f) {
      return f.holds() == std::optional(false) || f.why_not().empty();
    }));
  }
}

TEST_CASE("findings: one whose frames were not run is open") {
  PaperResults results = as_in_the_paper();
  for (MeasuredRun& r : results.runs) r.frames.resize(10);
  CHECK(verdict(results, "Combined settles faster than local after the camera cut") == std::nullopt);
  CHECK(find(findings(results), "Global answers").measured().find("in 33-34: not measured") !=
        std::string::npos);
  CHECK(verdict(results, "Two runs") == std::nullopt);
}

TEST_CASE("findings: speedup is measured against one rank with p times the time") {
  PaperResults results;
  for (const int ranks : {1, 2, 4}) {
    add(results, run_of(kScaling, ranks, BalanceMode::kCombined), 10,
        [ranks](FrameMeasures& m) { m.mean_weight = ranks == 4 ? 0.125 : 0.1; });
    PaperRun alone = run_of(kShortFrame, 1, BalanceMode::kCombined);
    alone.share = 1.0 / ranks;
    add(results, alone, 10, [ranks](FrameMeasures& m) { m.mean_weight = 0.1 * ranks; });
  }
  const std::vector<Speedup> values = speedups(Runs(results));
  REQUIRE(values.size() == 3);
  CHECK(values[2].ranks == 4);
  CHECK(values[2].same_work == Approx(0.8));
  CHECK(values[2].same_frame == Approx(3.2));
  CHECK(verdict(results, "A further rank") == std::optional(false));
  CHECK(find(findings(results), "A further rank").why_not() == "p = 4: 0.800");
  const Change better = [](FrameMeasures& m) { m.mean_weight = 0.1; };
  CHECK(verdict(with(results, kScaling, BalanceMode::kCombined, better), "A further rank") ==
        std::optional(true));
}

TEST_CASE("findings: samples lost at a repartition, and kept") {
  PaperResults results;
  for (const bool keep : {false, true}) {
    PaperRun run = run_of(kCasting, 62, BalanceMode::kCombined);
    run.keep_samples = keep;
    add(results, run, 10, [keep](FrameMeasures& m) {
      m.repartitioned = m.number == 4;
      if (m.number == 4) m.samples *= keep ? 0.97 : 0.8;
    });
  }
  CHECK(verdict(results, "A repartition") == std::optional(true));
  results.runs[1].frames[3].samples *= 0.9;
  CHECK(verdict(results, "A repartition") == std::optional(false));
  results.runs[1].frames[3].repartitioned = false;
  CHECK(verdict(results, "A repartition") == std::nullopt);
}

TEST_CASE("findings: the overhead of balancing for each number of ranks") {
  PaperResults results;
  for (const int ranks : {1, 8, 64}) {
    add(results, run_of(kScaling, ranks, BalanceMode::kNone), 10);
    add(results, run_of(kScaling, ranks, BalanceMode::kCombined), 10,
        [ranks](FrameMeasures& m) { m.samples *= ranks == 64 ? 0.9 : 0.97; });
  }
  add(results, run_of(kScaling, 256, BalanceMode::kCombined),
      10);  // on a large picture, with nothing to compare
  const std::string claim = "Balancing's overhead";
  CHECK(verdict(results, claim) == std::optional(true));
  for (FrameMeasures& m : results.runs[5].frames) m.samples *= 0.9;
  CHECK(find(findings(results), claim).why_not() == "greatest - least: 0.160");
}

TEST_CASE("findings: balance while casting, samples kept and dropped") {
  PaperResults results;
  const auto add_mode = [&](BalanceMode mode, bool keep, double level) {
    PaperRun run = run_of(kCasting, 62, mode);
    run.keep_samples = keep;
    add(results, run, 40, [level](FrameMeasures& m) { m.mean_weight_deviation = level, m.distance = level; });
  };
  add_mode(BalanceMode::kNone, false, 0.5);
  add_mode(BalanceMode::kLocal, false, 0.3);
  add_mode(BalanceMode::kCombined, false, 0.1);
  add_mode(BalanceMode::kCombined, true, 0.12);
  CHECK(verdict(results, "With casting too") == std::optional(true));
  CHECK(verdict(results, "Where samples are handed over") == std::optional(true));
  for (FrameMeasures& m : results.runs[3].frames) m.distance = 0.4;
  CHECK(find(findings(results), "Where samples are handed over").why_not() == "distance to serial: 0.400");
  for (FrameMeasures& m : results.runs[1].frames) m.mean_weight_deviation = 0.6;
  CHECK(find(findings(results), "With casting too").why_not() == "local's: 0.600");
}

TEST_CASE("findings: the samples with casting rise and level off") {
  PaperResults results;
  PaperRun run = run_of(kGrowth, 1, BalanceMode::kCombined);
  add(results, run, 10);
  run.cast = CastChoice::kPaper;
  add(results, run, 10, [](FrameMeasures& m) { m.samples += 1000 * std::min(m.number, 5); });
  CHECK(verdict(results, "Casting raises") == std::optional(true));
  for (FrameMeasures& m : results.runs[1].frames) m.samples += m.number > 5 ? 1000 * m.number : 0;
  CHECK(verdict(results, "Casting raises") == std::optional(false));
}

TEST_CASE("findings: costs by stage and bytes by kind") {
  PaperResults results;
  for (const int ranks : {1, 8, 64}) {
    add(results, run_of(kCosts, ranks, BalanceMode::kCombined), 10, [ranks](FrameMeasures& m) {
      m.cpu_ms.sampling = 20, m.cpu_ms.casting = 5, m.cpu_ms.reconstruction = 2, m.cpu_ms.balancing = 1;
      m.bytes.samples = 1e4 * ranks, m.bytes.pixels = 2e5, m.bytes.balance = 1e3 * ranks;
    });
  }
  CHECK(verdict(results, "Sampling dominates") == std::optional(true));
  CHECK(verdict(results, "Sample updates") == std::optional(true));
  for (FrameMeasures& m : results.runs[2].frames) m.cpu_ms.casting = 30, m.bytes.pixels = 2e6;
  CHECK(verdict(results, "Sampling dominates") == std::optional(false));
  CHECK(find(findings(results), "Sample updates").why_not() == "samples: 640");
}

TEST_CASE("findings: a network is judged only where a slower one makes a difference") {
  PaperResults results;
  add(results, run_of(kSimple, 62, BalanceMode::kCombined), 10);
  for (const double microseconds : {0.0, 1.0, 10.0, 100.0}) {
    PaperRun run = run_of(kLatency, 62, BalanceMode::kCombined);
    run.machine.latency_s = 1e-6 * microseconds;
    add(results, run, 10, [=](FrameMeasures& m) { m.mean_weight = microseconds >= 10 ? 1.2 : 1.0; });
  }
  const std::string claim = "The machine's network is good enough in latency";
  CHECK(verdict(results, claim) == std::optional(true));
  CHECK(find(findings(results), claim).measured() == "own: 1; above 1.1 first at, microseconds: 10");
  PaperResults harmless = results;
  for (MeasuredRun& r : harmless.runs) {
    for (FrameMeasures& m : r.frames) m.mean_weight = 1;
  }
  CHECK(verdict(harmless, claim) == std::nullopt);  // what makes no difference shows nothing
  const Change worse = [](FrameMeasures& m) { m.mean_weight = 1.06; };
  CHECK(verdict(with(results, kSimple, BalanceMode::kCombined, worse), claim) == std::optional(false));
}

TEST_CASE("findings: auto casting is within 2 % of the best, or the sequences beyond are named") {
  PaperResults results;
  const std::string claim = "Judged by true error";
  CHECK(verdict(results, claim) == std::nullopt);
  results.casting_errors = {{{"tree", 1}, 0.3, {0.02, 0.03, 0.021, 0.0203}},
                            {{"balls", 1}, 1.5, {0.03, 0.02, 0.02, 0.02}}};
  CHECK(verdict(results, claim) == std::optional(true));
  results.casting_errors[1].rmse.back() = 0.021;
  CHECK(verdict(results, claim) == std::optional(false));
  CHECK(find(findings(results), claim).why_not() == "balls at speed 1, 1.5 samples per pixel: 1.050");
}

TEST_CASE("findings: two runs are the same when every picture is") {
  PaperResults results;
  const Change hash = [](FrameMeasures& m) { m.picture_hash = std::to_string(m.number); };
  add(results, run_of(kSimple, 32, BalanceMode::kCombined), 40, hash);
  add(results, run_of(kRepeat, 32, BalanceMode::kCombined), 5, hash);
  CHECK(verdict(results, "Two runs") == std::optional(true));
  results.runs[1].frames[4].picture_hash = "another";
  CHECK(verdict(results, "Two runs") == std::optional(false));
}

}  // namespace pprt::findings_test
