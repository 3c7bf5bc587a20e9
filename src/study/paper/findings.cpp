#include "study/paper/findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "study/paper/measures.h"

namespace pprt {
namespace {

using enum BalanceMode;
using enum Relation;
using F = FrameMeasures;

constexpr std::array kSettled = {kStill, Frames{25, 30},
                                 Frames{36, 40}};  // the camera has rested for some frames
constexpr const char* kSettledText = "frames 5-10, 25-30 and 36-40";
constexpr std::array kRelations = {"", "below", "above", "at most", "at least"};  // indexed by Relation

std::string number(double value) {
  if (std::isnan(value)) return "not measured";
  if (std::isinf(value)) return "never";
  return fmt::format("{:.{}f}", value, value == std::floor(value) || std::abs(value) >= 100 ? 0 : 3);
}

std::vector<Check> bounded(std::vector<Check> checks) {
  std::erase_if(checks, [](const Check& c) { return c.relation == kReported; });
  return checks;
}

// A measure under each mode of balancing.
struct ByMode {
  double none, local, global, combined;
};

// Judges the runs, experiment by experiment.
struct Judge {
  const Runs& runs;
  std::vector<Finding> all = {};

  template <typename Level>
  ByMode by_mode(int ranks, const Level& level) const {
    const auto of = [&](BalanceMode mode) { return double(level(runs.find(kSimple, ranks, mode))); };
    return {of(kNone), of(kLocal), of(kGlobal), of(kCombined)};
  }
  ByMode over(int ranks, Frames frames, const Measure& measure) const {
    return by_mode(ranks, [&](const MeasuredRun& run) { return mean(run, frames, measure); });
  }
  ByMode settled(int ranks, const Measure& measure) const;  // mean over the parts of kSettled that were run

  Finding& add(std::string source, std::string claim, std::string frames = "",
               std::vector<Check> checks = {}) {
    return all.emplace_back(
        Finding{std::move(source), std::move(claim), std::move(frames), std::move(checks)});
  }

  void balancing(int ranks);
  void settling(int ranks, Frames part, const char* when, double within);
  void patterns(std::string_view experiment);
  void scaling();
  void costs();
  void casting();
  void casting_errors(const std::vector<CastingErrors>& errors);
  void network(std::string_view experiment, const char* unit,
               const std::function<double(const Machine&)>& value);
  void repeat();
};

ByMode Judge::settled(int ranks, const Measure& measure) const {
  return by_mode(ranks, [&](const MeasuredRun& run) {
    double sum = 0;
    int parts = 0;
    for (const Frames& part : kSettled) {
      if (const double value = mean(run, part, measure); !std::isnan(value)) sum += value, ++parts;
    }
    return parts > 0 ? sum / parts : kNoValue;
  });
}

void Judge::balancing(int ranks) {
  const std::string on = fmt::format(" ({} ranks)", ranks);
  const ByMode deviation = settled(ranks, relative_deviation), distance = settled(ranks, &F::distance);
  add("6.4.1, figures 5b 5c 6b 6c", "Any load balancing is far better than none" + on, kSettledText,
      {{"deviation/mean with local", deviation.local, kBelow, deviation.none, "none's"},
       {"with global", deviation.global, kBelow, deviation.none, "none's"},
       {"with combined", deviation.combined, kBelow, deviation.none, "none's"},
       {"distance to serial with local", distance.local, kBelow, distance.none, "none's"},
       {"with global", distance.global, kBelow, distance.none, "none's"},
       {"with combined", distance.combined, kBelow, distance.none, "none's"}});

  Finding& even = add("ours, after figures 5b 6b",
                      "With combined balancing all regions are about equally refined" + on, "");
  for (const Frames& part : kSettled) {
    even.checks.push_back({fmt::format("deviation/mean in frames {}-{}", part.first, part.last),
                           mean(runs.find(kSimple, ranks, kCombined), part, relative_deviation), kAtMost,
                           ranks <= 32 ? 0.20 : 0.25});
  }
  even.checks.push_back(
      {"on average", deviation.combined, kAtMost, 0.2 * deviation.none, "a fifth of none's"});

  settling(ranks, kStart, "at the start", kNever);
  settling(ranks, kAfterCameraCut, "after the camera cut", 3);
  const ByMode at_cut = over(ranks, {31, 31}, relative_deviation);
  add("6.4.1, figures 5b 6b", "Global answers a camera cut one or two frames late, and more abruptly" + on,
      "frames 31-34",
      {{"global's deviation/mean at 31", at_cut.global, kAbove, at_cut.combined, "combined's"},
       {"in 33-34", over(ranks, {33, 34}, relative_deviation).global, kAtMost, 0.5 * at_cut.global,
        "half of that at 31"}});

  const ByMode samples = over(ranks, kWhole, &F::samples), cuts = by_mode(ranks, repartitions);
  add("6.4.1, 6.5", "Combined is almost as good as global, at little more than local's cost" + on, "",
      {{"combined's distance to serial", distance.combined, kAtMost, distance.global + 0.03,
        "global's + 0.03"},
       {"repartitions", cuts.combined, kAtMost, cuts.global / 3, "a third of global's"},
       {"samples", samples.combined, kAtLeast, 0.95 * samples.local, "0.95 of local's"}});

  const ByMode received = over(ranks, kWhole, received_per_sample);
  add("6.4.1, figures 5d 6d", "Without balancing there are more samples, though in worse places" + on, "",
      {{"samples with none", samples.none, kAbove, samples.combined, "combined's"},
       {"other ranks that receive a sample, none", received.none},
       {"combined", received.combined}});
}

void Judge::settling(int ranks, Frames part, const char* when, double within) {
  const MeasuredRun& combined = runs.find(kSimple, ranks, kCombined);
  const double level = 1.5 * mean(combined, {part.last - 3, part.last}, relative_deviation);
  const double fast = frames_to_settle(combined, part, level);
  const double slow = frames_to_settle(runs.find(kSimple, ranks, kLocal), part, level);
  Finding& finding = add(
      "6.4.1, figures 5b 6b", fmt::format("Combined settles faster than local {} ({} ranks)", when, ranks),
      fmt::format("until deviation/mean is within 1.5 of combined's final value ({})", number(level)),
      {{"combined's frames", fast, kBelow, slow, "local's"}});
  if (within < kNever) finding.checks.push_back({"combined's frames", fast, kAtMost, within});
}

void Judge::patterns(std::string_view experiment) {
  for (const int ranks : runs.ranks_of(experiment)) {
    const MeasuredRun& combined = runs.find(experiment, ranks, kCombined);
    const std::string on = fmt::format(" ({} ranks)", ranks);
    const double distance = mean(combined, kStill, &F::distance);
    const double none = mean(runs.find(experiment, ranks, kNone), kStill, &F::distance);
    add("3.4, figure 2; ours", "Many ranks leave nearly the serial pattern" + on, "frames 5-10",
        {{"distance to serial", distance, kAtMost, 0.10},
         {"distance to serial", distance, kAtMost, 0.25 * none, "a quarter of none's"},
         {"deviation/mean", mean(combined, kStill, relative_deviation)}});
    const char* inside = "samples within 3 pixels of a border / the serial pattern's there";
    const double density = mean(combined, kStill, &F::border_density);
    add("3.4, figure 2b 2c", "No strips without samples along borders of regions" + on, "frames 5-10",
        {{inside, density, kAtLeast, 0.9}, {inside, density, kAtMost, 1.1}});
  }
}

void Judge::scaling() {
  for (const int side : runs.sides_of(kScaling)) {
    Finding& flat =
        add("6.3, 7.1, figure 8",
            fmt::format("A further rank brings as much as those before it, at {0}x{0} pixels", side),
            "Refine(1, f/p) / Refine(p, f), frames 5-10");
    for (const Speedup& s : speedups(runs)) {
      if (s.side != side) continue;
      const MeasuredRun& run = runs.find(kScaling, [&](const PaperRun& r) {
        return r.side == side && r.ranks == s.ranks && r.balance == kCombined;
      });
      flat.checks.push_back(
          {fmt::format("p = {}", s.ranks), s.same_work, kAtLeast, side >= 2 * kPaperSide ? 0.90 : 0.85});
      flat.checks.push_back({"received per sample", mean(run, kStill, received_per_sample)});
    }
  }
  double least = kNever, most = -kNever;
  Finding& overhead =
      add("6.4.3, figures 8a 8d", "Balancing's overhead per rank does not grow with their number",
          "samples with combined / with none, frames 5-10");
  for (const int ranks : runs.ranks_of(kScaling)) {
    if (ranks == 1) continue;
    const auto samples = [&](BalanceMode mode) {
      return mean(runs.find(kScaling, ranks, mode), kStill, &F::samples);
    };
    const double ratio = samples(kCombined) / samples(kNone);
    least = std::min(ratio, least), most = std::max(ratio, most);
    overhead.checks.push_back({fmt::format("p = {}", ranks), ratio});
  }
  overhead.checks.push_back({"greatest - least", most < least ? kNoValue : most - least, kAtMost, 0.1});
}

void Judge::costs() {
  Finding& sampling =
      add("6.4.4, figure 9a", "Sampling dominates the cost of a frame, on any number of ranks",
          "share of the time of all stages, frames 1-10");
  for (const MeasuredRun* run : runs.all(kCosts)) {
    const double stages = mean(*run, kStart, cpu_ms);
    sampling.checks.push_back({fmt::format("p = {}", run->run.ranks),
                               mean(*run, kStart, [](const F& m) { return m.cpu_ms.sampling; }) / stages,
                               kAtLeast, 0.5});
    sampling.checks.push_back(
        {"casting", mean(*run, kStart, [](const F& m) { return m.cpu_ms.casting; }) / stages});
  }
  const std::vector<int> counts = runs.ranks_of(kCosts);
  const auto kilobytes = [&](std::size_t from_last, const Measure& bytes) {
    const int ranks = counts.size() > from_last ? counts[counts.size() - 1 - from_last] : 0;
    return 1e-3 * mean(runs.find(kCosts, ranks, kCombined), kStart, bytes);
  };
  const auto samples_sent = [](const F& m) { return m.bytes.samples; };
  const double samples = kilobytes(0, samples_sent);
  const auto balancing = [](const F& m) { return m.bytes.balance + m.bytes.progress; };
  all.push_back(
      {"6.4.4, figure 9b",
       "Sample updates are most of what is sent, and grow fastest",
       "kB per frame on the most ranks, frames 1-10",
       {{"samples", samples, kAbove, kilobytes(0, [](const F& m) { return m.bytes.pixels; }), "pixels'"},
        {"samples", samples, kAbove, kilobytes(0, balancing), "balancing's and progress'"},
        {"samples", samples, kAbove, kilobytes(1, samples_sent), "that on half as many ranks"}}});
}

void Judge::casting() {
  const auto samples = [&](CastChoice cast, Frames frames) {
    return mean(runs.find(kGrowth, [cast](const PaperRun& run) { return run.cast == cast; }), frames,
                &F::samples);
  };
  const double fifth = samples(CastChoice::kPaper, {5, 5}), later = samples(CastChoice::kPaper, {6, 10});
  all.push_back(
      {"6.4.5, figure 9c",
       "Casting raises the samples over the first five frames, then they level off",
       "one rank",
       {{"samples in frame 5", fifth, kAtLeast, 1.1 * samples(CastChoice::kPaper, {1, 1}), "1.1 of frame 1"},
        {"in 6-10", later, kAtLeast, 0.9 * fifth, "0.9 of frame 5"},
        {"in 6-10", later, kAtMost, 1.1 * fifth, "1.1 of frame 5"},
        {"without casting", samples(CastChoice::kOff, kStill)}}});

  const auto run = [&](BalanceMode mode, bool keep) -> const MeasuredRun& {
    return runs.find(kCasting,
                     [=](const PaperRun& r) { return r.balance == mode && r.keep_samples == keep; });
  };
  const MeasuredRun &kept = run(kCombined, true), &dropped = run(kCombined, false);
  const auto level = [&](BalanceMode mode, const Measure& measure) {
    return mean(run(mode, false), {5, 40}, measure);
  };
  const Measure distance = &F::distance;
  const double local_deviation = level(kLocal, relative_deviation), local_distance = level(kLocal, distance);
  all.push_back(
      {"6.4.2, figures 7b 7c",
       "With casting too, combined balances better than local, and local better than none",
       "frames 5 to the last",
       {{"combined's deviation/mean", level(kCombined, relative_deviation), kBelow, local_deviation,
         "local's"},
        {"local's", local_deviation, kBelow, level(kNone, relative_deviation), "none's"},
        {"combined's distance to serial", level(kCombined, distance), kBelow, local_distance, "local's"},
        {"local's", local_distance, kBelow, level(kNone, distance), "none's"}}});
  all.push_back(
      {"6.4.2, figures 7a 7d; ours",
       "A repartition that drops the samples cast costs a frame its samples; handing them over does not",
       "greatest loss from one frame to the next, share of the samples",
       {{"dropped", worst_loss(dropped), kAtLeast, 0.10}, {"handed over", worst_loss(kept), kAtMost, 0.05}}});
  all.push_back(
      {"ours, after 6.4.2",
       "Where samples are handed over at a repartition, balance is as good as where they are dropped",
       "frames 5 to the last",
       {{"distance to serial", mean(kept, {5, 40}, distance), kAtMost, level(kCombined, distance) + 0.03,
         "dropped + 0.03"},
        {"repartitions", 1.0 * repartitions(kept)}}});
}

void Judge::casting_errors(const std::vector<CastingErrors>& errors) {
  Finding& finding = add("ours", "Judged by true error, auto is never worse than off, paper and verified",
                         "mean RMSE with auto / the least of the others'");
  for (const CastingErrors& e : errors) {
    finding.checks.push_back({fmt::format("{} at speed {:g}, {:g} samples per pixel", e.sequence.scene,
                                          e.sequence.speed, e.samples_per_pixel),
                              e.auto_ratio(), kAtMost, 1.02});
  }
}

// A control must show that a network can be too slow: without one that makes refinement 10 % worse, the
// finding is open.
void Judge::network(std::string_view experiment, const char* unit,
                    const std::function<double(const Machine&)>& value) {
  const auto level = [](const MeasuredRun& run) { return mean(run, kStill, &F::refinement); };
  const std::vector<const MeasuredRun*> tried = runs.all(experiment);  // the best network first
  const int ranks = tried.empty() ? 0 : tried.back()->run.ranks;
  const double best = tried.empty() ? kNoValue : level(*tried.front());
  const auto slow = std::find_if(tried.begin(), tried.end(),
                                 [&](const MeasuredRun* run) { return level(*run) > 1.1 * best; });
  Finding& finding = add(
      "6.4.4; ours", fmt::format("The machine's network is good enough in {} ({} ranks)", experiment, ranks),
      "refinement / that with the best network tried, frames 5-10");
  const double own = level(runs.find(kSimple, ranks, kCombined)) / best;
  if (slow == tried.end()) {
    finding.checks = {{"own (no network tried makes it 1.1)", own}};
  } else {
    finding.checks = {{"own", own, kAtMost, 1.05},
                      {fmt::format("above 1.1 first at, {}", unit), value((*slow)->run.machine)}};
  }
}

void Judge::repeat() {
  const std::vector<int> counts = runs.ranks_of(kRepeat);
  const int ranks = counts.empty() ? 0 : counts.front();
  const std::vector<F>& first = runs.find(kSimple, ranks, kCombined).frames;
  const std::vector<F>& again = runs.find(kRepeat, ranks, kCombined).frames;
  double equal = 0;
  for (std::size_t i = 0; i < std::min(first.size(), again.size()); ++i) {
    equal += first[i].picture_hash == again[i].picture_hash;
  }
  const double frames = again.empty() ? kNoValue : static_cast<double>(again.size());
  add("ours", fmt::format("Two runs under the work clock make the same pictures ({} ranks)", ranks), "",
      {{"equal frames", equal, kAtLeast, frames, "those of the second run"}});
}

}  // namespace

std::optional<bool> Check::met() const {
  if (relation == kReported || std::isnan(value) || std::isnan(bound)) return std::nullopt;
  const bool is_upper = relation == kBelow || relation == kAtMost;
  if (value == bound) return relation == kAtMost || relation == kAtLeast;
  return is_upper == (value < bound);
}

std::optional<bool> Finding::holds() const {
  const std::vector<Check> all = bounded(checks);
  if (all.empty() || std::any_of(all.begin(), all.end(), [](const Check& c) { return !c.met(); }))
    return std::nullopt;
  return std::all_of(all.begin(), all.end(), [](const Check& c) { return *c.met(); });
}

std::string Finding::criterion() const {
  std::vector<std::string> bounds, quantities;
  for (const Check& c : bounded(checks)) {
    bounds.push_back(fmt::format("{} {}", kRelations.at(static_cast<std::size_t>(c.relation)),
                                 c.bound_name.empty() ? fmt::format("{:g}", c.bound) : c.bound_name));
    quantities.push_back(c.quantity);
  }
  const std::size_t count = bounds.size();
  if (count > 2 && std::count(bounds.begin(), bounds.end(), bounds[0]) == std::ptrdiff_t(count)) {
    bounds = {bounds[0]}, quantities = {"each"};
  }
  for (std::size_t i = 0; i < bounds.size(); ++i) bounds[i] = quantities[i] + " " + bounds[i];
  return fmt::format("{}{}{}", frames, frames.empty() || bounds.empty() ? "" : ": ", fmt::join(bounds, "; "));
}

std::string Finding::measured() const {
  std::string text, last;
  for (const Check& c : checks) {
    if (c.quantity != last)
      text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", c.quantity, number(c.value));
    if (!c.bound_name.empty()) text += fmt::format(" ({}: {})", c.bound_name, number(c.bound));
    last = c.quantity;
  }
  return text;
}

std::string Finding::why_not() const {
  std::vector<std::string> failures;
  if (!holds().value_or(true)) {
    for (const Check& c : bounded(checks)) {
      if (!*c.met()) failures.push_back(fmt::format("{}: {}", c.quantity, number(c.value)));
    }
  }
  return fmt::format("{}", fmt::join(failures, "; "));
}

std::vector<Finding> findings(const PaperResults& results) {
  const Runs runs(results);
  Judge judge{runs};
  const std::vector<int> counts = runs.ranks_of(kSimple);
  for (const int ranks : counts) judge.balancing(ranks);
  if (!counts.empty()) {  // the criteria of evenness and of the pattern must be able to fail
    judge.all.push_back(
        {"ours",
         fmt::format("Control: without balancing the measures of evenness and pattern are bad ({} ranks)",
                     counts.back()),
         "frames 5-10",
         {{"deviation/mean with none", judge.over(counts.back(), kStill, relative_deviation).none, kAbove,
           0.25},
          {"distance to serial with none", judge.over(counts.back(), kStill, &F::distance).none, kAbove,
           0.10}}});
  }
  judge.patterns(kPattern);
  judge.patterns(kSimple);
  judge.scaling();
  judge.costs();
  judge.casting();
  judge.casting_errors(results.casting_errors);
  judge.network(kLatency, "microseconds", [](const Machine& m) { return 1e6 * m.latency_s; });
  judge.network(kBandwidth, "MB/s", [](const Machine& m) { return 1e-6 * m.bytes_per_second; });
  judge.repeat();
  return std::move(judge.all);
}

}  // namespace pprt
