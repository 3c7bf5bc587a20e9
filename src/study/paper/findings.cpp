#include "study/paper/findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/counted.h"
#include "study/paper/measures.h"

namespace pprt {
namespace {

using enum BalanceMode;
using enum Relation;
using F = FrameMeasures;
using Findings = std::vector<Finding>;

constexpr std::array kSettled = {kStill, Frames{25, 30},
                                 Frames{36, 40}};  // the camera has rested for some frames
constexpr const char* kSettledText = "frames 5-10, 25-30 and 36-40";
constexpr const char* kStillText = "frames 5-10";
constexpr std::array kRelations = {"", "below", "above", "at most", "at least"};  // indexed by Relation

std::string number(double value) {
  if (std::isnan(value)) return "not measured";
  if (std::isinf(value)) return "never";
  return fmt::format("{:.{}f}", value, value == std::floor(value) || std::abs(value) >= 100 ? 0 : 3);
}

std::string on_ranks(std::string_view claim, int ranks) {
  return fmt::format("{} ({})", claim, counted(ranks, "rank", "ranks"));
}

std::vector<Check> bounded(std::vector<Check> checks) {
  std::erase_if(checks, [](const Check& c) { return c.relation == kReported; });
  return checks;
}

// A figure of the simple sequence under each mode of balancing.
struct ByMode {
  double none, local, global, combined;
};

template <typename Figure>
ByMode by_mode(const Runs& runs, int ranks, const Figure& figure) {
  const auto of = [&](BalanceMode mode) {
    return static_cast<double>(figure(runs.find(kSimple, ranks, mode)));
  };
  return {of(kNone), of(kLocal), of(kGlobal), of(kCombined)};
}

ByMode mean_by_mode(const Runs& runs, int ranks, Frames frames, const FrameMeasure& measure) {
  return by_mode(runs, ranks, [&](const MeasuredRun& run) { return mean(run, frames, measure); });
}

// Means over the parts of kSettled that were run.
ByMode settled_by_mode(const Runs& runs, int ranks, const FrameMeasure& measure) {
  return by_mode(runs, ranks, [&](const MeasuredRun& run) {
    double sum = 0;
    int parts = 0;
    for (const Frames& part : kSettled) {
      if (const double value = mean(run, part, measure); !std::isnan(value)) sum += value, ++parts;
    }
    return parts > 0 ? sum / parts : kNoValue;
  });
}

Finding evenness(const Runs& runs, int ranks, const ByMode& deviation) {
  std::vector<Check> checks;
  for (const Frames& part : kSettled) {
    checks.push_back({fmt::format("deviation/mean in frames {}-{}", part.first, part.last),
                      mean(runs.find(kSimple, ranks, kCombined), part, relative_deviation), kAtMost,
                      ranks <= 32 ? 0.20 : 0.25});
  }
  checks.push_back({"on average", deviation.combined, kAtMost, 0.2 * deviation.none, "a fifth of none's"});
  return {"ours, after figures 5b 6b",
          on_ranks("With combined balancing all regions are about equally refined", ranks), "", checks};
}

Finding settling(const Runs& runs, int ranks, Frames part, const char* claim, double within) {
  const MeasuredRun& combined = runs.find(kSimple, ranks, kCombined);
  const double level = 1.5 * mean(combined, {part.last - 3, part.last}, relative_deviation);
  const double fast = frames_to_settle(combined, part, level);
  const double slow = frames_to_settle(runs.find(kSimple, ranks, kLocal), part, level);
  std::vector<Check> checks = {{"combined's frames", fast, kBelow, slow, "local's"}};
  if (within < kNever) checks.push_back({"combined's frames", fast, kAtMost, within});
  return {"6.4.1, figures 5b 6b", on_ranks(claim, ranks),
          fmt::format("until deviation/mean is within 1.5 of combined's final value ({})", number(level)),
          checks};
}

Findings balancing(const Runs& runs, int ranks) {
  const ByMode deviation = settled_by_mode(runs, ranks, relative_deviation);
  const ByMode distance = settled_by_mode(runs, ranks, &F::distance);
  const ByMode at_cut = mean_by_mode(runs, ranks, {31, 31}, relative_deviation);
  const ByMode after_cut = mean_by_mode(runs, ranks, {33, 34}, relative_deviation);
  const ByMode samples = mean_by_mode(runs, ranks, kWhole, &F::samples);
  const ByMode cuts = by_mode(runs, ranks, repartitions);
  const ByMode received = mean_by_mode(runs, ranks, kWhole, received_per_sample);
  return {
      {"6.4.1, figures 5b 5c 6b 6c",
       on_ranks("Any load balancing is far better than none", ranks),
       kSettledText,
       {{"deviation/mean with local", deviation.local, kBelow, deviation.none, "none's"},
        {"with global", deviation.global, kBelow, deviation.none, "none's"},
        {"with combined", deviation.combined, kBelow, deviation.none, "none's"},
        {"distance to serial with local", distance.local, kBelow, distance.none, "none's"},
        {"with global", distance.global, kBelow, distance.none, "none's"},
        {"with combined", distance.combined, kBelow, distance.none, "none's"}}},
      evenness(runs, ranks, deviation),
      settling(runs, ranks, kStart, "Combined settles faster than local at the start", kNever),
      settling(runs, ranks, kAfterCameraCut, "Combined settles faster than local after the camera cut", 3),
      {"6.4.1, figures 5b 6b",
       on_ranks("Global answers a camera cut one or two frames late, and more abruptly", ranks),
       "frames 31-34",
       {{"global's deviation/mean at 31", at_cut.global, kAbove, at_cut.combined, "combined's"},
        {"in 33-34", after_cut.global, kAtMost, 0.5 * at_cut.global, "half of that at 31"}}},
      {"6.4.1, 6.5",
       on_ranks("Combined is almost as good as global, at little more than local's cost", ranks),
       "",
       {{"combined's distance to serial", distance.combined, kAtMost, distance.global + 0.03,
         "global's + 0.03"},
        {"repartitions", cuts.combined, kAtMost, cuts.global / 3, "a third of global's"},
        {"samples", samples.combined, kAtLeast, 0.95 * samples.local, "0.95 of local's"}}},
      {"6.4.1, figures 5d 6d",
       on_ranks("Without balancing there are more samples, though in worse places", ranks),
       "",
       {{"samples with none", samples.none, kAbove, samples.combined, "combined's"},
        {"other ranks that receive a sample, none", received.none},
        {"combined", received.combined}}}};
}

// Shows that the criteria of evenness and of the pattern can fail.
Finding control(const Runs& runs, int ranks) {
  return {
      "ours",
      on_ranks("Control: without balancing the measures of evenness and pattern are bad", ranks),
      kStillText,
      {{"deviation/mean with none", mean_by_mode(runs, ranks, kStill, relative_deviation).none, kAbove, 0.25},
       {"distance to serial with none", mean_by_mode(runs, ranks, kStill, &F::distance).none, kAbove, 0.10}}};
}

Findings pattern(const Runs& runs, std::string_view experiment, int ranks) {
  const MeasuredRun& combined = runs.find(experiment, ranks, kCombined);
  const double distance = mean(combined, kStill, &F::distance);
  const double none = mean(runs.find(experiment, ranks, kNone), kStill, &F::distance);
  const char* inside = "samples within 3 pixels of a border / the serial pattern's there";
  const double density = mean(combined, kStill, &F::border_density);
  return {{"3.4, figure 2; ours",
           on_ranks("Many ranks leave nearly the serial pattern", ranks),
           kStillText,
           {{"distance to serial", distance, kAtMost, 0.10},
            {"distance to serial", distance, kAtMost, 0.25 * none, "a quarter of none's"},
            {"deviation/mean", mean(combined, kStill, relative_deviation)}}},
          {"3.4, figure 2b 2c",
           on_ranks("No strips without samples along borders of regions", ranks),
           kStillText,
           {{inside, density, kAtLeast, 0.9}, {inside, density, kAtMost, 1.1}}}};
}

Finding scaling(const Runs& runs, int side) {
  std::vector<Check> checks;
  for (const Speedup& s : speedups(runs)) {
    if (s.side != side) continue;
    const MeasuredRun& run = runs.find(kScaling, [&](const PaperRun& r) {
      return r.side == side && r.ranks == s.ranks && r.balance == kCombined;
    });
    checks.push_back(
        {fmt::format("p = {}", s.ranks), s.same_work, kAtLeast, side >= 2 * kPaperSide ? 0.90 : 0.85});
    checks.push_back({"received per sample", mean(run, kStill, received_per_sample)});
  }
  return {"6.3, 7.1, figure 8",
          fmt::format("A further rank brings as much as those before it, at {0}x{0} pixels", side),
          "Refine(1, f/p) / Refine(p, f), frames 5-10", checks};
}

Finding overhead(const Runs& runs) {
  std::vector<Check> checks;
  double least = kNever, most = -kNever;
  for (const int ranks : runs.distinct(kScaling, &PaperRun::ranks)) {
    if (ranks == 1 || runs.find(kScaling, ranks, kNone).frames.empty()) continue;
    const auto samples = [&](BalanceMode mode) {
      return mean(runs.find(kScaling, ranks, mode), kStill, &F::samples);
    };
    const double ratio = samples(kCombined) / samples(kNone);
    least = std::min(ratio, least), most = std::max(ratio, most);
    checks.push_back({fmt::format("p = {}", ranks), ratio});
  }
  checks.push_back({"greatest - least", most < least ? kNoValue : most - least, kAtMost, 0.1});
  return {"6.4.3, figures 8a 8d", "Balancing's overhead per rank does not grow with their number",
          "samples with combined / with none, frames 5-10", checks};
}

Findings costs(const Runs& runs) {
  std::vector<Check> shares;
  for (const MeasuredRun* run : runs.all(kCosts)) {
    const auto share = [&](double StageTimes::*stage) {
      return mean(*run, kStart, time_of(stage)) / mean(*run, kStart, cpu_ms);
    };
    shares.push_back({fmt::format("p = {}", run->ranks), share(&StageTimes::sampling), kAtLeast, 0.5});
    shares.push_back({"casting", share(&StageTimes::casting)});
  }
  const std::vector<int> counts = runs.distinct(kCosts, &PaperRun::ranks);
  const auto kilobytes = [&](std::size_t from_last, std::uint64_t BytesSent::*kind) {
    const int ranks = counts.size() > from_last ? counts[counts.size() - 1 - from_last] : 0;
    return mean(runs.find(kCosts, ranks, kCombined), kStart, kilobytes_of(kind));
  };
  const double samples = kilobytes(0, &BytesSent::samples);
  const double balancing = kilobytes(0, &BytesSent::balance) + kilobytes(0, &BytesSent::progress);
  return {{"6.4.4, figure 9a", "Sampling dominates the cost of a frame, on any number of ranks",
           "share of the time of all stages, frames 1-10", shares},
          {"6.4.4, figure 9b",
           "Sample updates are most of what is sent, and grow fastest",
           "kB per frame on the most ranks, frames 1-10",
           {{"samples", samples, kAbove, kilobytes(0, &BytesSent::pixels), "pixels'"},
            {"samples", samples, kAbove, balancing, "balancing's and progress'"},
            {"samples", samples, kAbove, kilobytes(1, &BytesSent::samples), "that on half as many ranks"}}}};
}

Finding growth(const Runs& runs) {
  const auto samples = [&](CastChoice cast, Frames frames) {
    return mean(runs.find(kGrowth, [cast](const PaperRun& run) { return run.cast == cast; }), frames,
                &F::samples);
  };
  const double first = samples(CastChoice::kPaper, {1, 1}), fifth = samples(CastChoice::kPaper, {5, 5});
  const double later = samples(CastChoice::kPaper, {6, 10});
  return {"6.4.5, figure 9c",
          "Casting raises the samples over the first five frames, then they level off",
          "one rank",
          {{"samples in frame 5", fifth, kAtLeast, 1.1 * first, "1.1 of frame 1"},
           {"in 6-10", later, kAtLeast, 0.9 * fifth, "0.9 of frame 5"},
           {"in 6-10", later, kAtMost, 1.1 * fifth, "1.1 of frame 5"},
           {"without casting", samples(CastChoice::kOff, kStill)}}};
}

Findings casting(const Runs& runs) {
  constexpr Frames kFromFifth = {5, 40};
  const auto run = [&](BalanceMode mode, bool keep) -> const MeasuredRun& {
    return runs.find(kCasting,
                     [=](const PaperRun& r) { return r.balance == mode && r.keep_samples == keep; });
  };
  const MeasuredRun &kept = run(kCombined, true), &dropped = run(kCombined, false);
  const auto deviation = [&](BalanceMode mode) {
    return mean(run(mode, false), kFromFifth, relative_deviation);
  };
  const auto distance = [&](BalanceMode mode) { return mean(run(mode, false), kFromFifth, &F::distance); };
  const MeasuredRun& alone =
      runs.find(kGrowth, [](const PaperRun& r) { return r.cast == CastChoice::kPaper; });
  return {
      {"6.4.2, figures 7b 7c",
       "With casting too, combined balances better than local, and local better than none",
       "frames 5 to the last",
       {{"combined's deviation/mean", deviation(kCombined), kBelow, deviation(kLocal), "local's"},
        {"local's", deviation(kLocal), kBelow, deviation(kNone), "none's"},
        {"combined's distance to serial", distance(kCombined), kBelow, distance(kLocal), "local's"},
        {"local's", distance(kLocal), kBelow, distance(kNone), "none's"}}},
      {"6.4.2, figures 7a 7d; ours",
       "A repartition that drops the samples cast costs a frame its samples; handing them over does not",
       "greatest loss from one frame to the next, share of the samples",
       {{"dropped", worst_loss(dropped), kAtLeast, 0.10}, {"handed over", worst_loss(kept), kAtMost, 0.05}}},
      {"ours, after 6.4.2",
       "Where samples are handed over at a repartition, balance is as good as where they are dropped",
       "frames 5 to the last",
       {{"distance to serial", mean(kept, kFromFifth, &F::distance), kAtMost, distance(kCombined) + 0.03,
         "dropped + 0.03"},
        {"one rank's, which hands nothing over", mean(alone, kFromFifth, &F::distance)},
        {"repartitions", static_cast<double>(repartitions(kept))}}}};
}

Finding auto_casting(const std::vector<CastingErrors>& errors) {
  std::vector<Check> checks;
  for (const CastingErrors& e : errors) {
    checks.push_back({fmt::format("{} at speed {:g}, {:g} samples per pixel", e.sequence.scene,
                                  e.sequence.speed, e.samples_per_pixel),
                      e.auto_ratio(), kAtMost, 1.02});
  }
  return {"ours", "Judged by true error, auto is never worse than off, paper and verified",
          "mean RMSE with auto / the least of the others'", checks};
}

// A control must show that a network can be too slow: without one that makes refinement 10 % worse, the
// finding is open.
Finding network(const Runs& runs, const NetworkProperty& property) {
  const auto level = [](const MeasuredRun& run) { return mean(run, kStill, &F::mean_weight); };
  const std::vector<const MeasuredRun*> tried = runs.all(property.experiment);  // the best network first
  const int ranks = tried.empty() ? 0 : tried.back()->ranks;
  const double best = tried.empty() ? kNoValue : level(*tried.front());
  const double own = level(runs.find(kSimple, ranks, kCombined)) / best;
  const auto slow = std::find_if(tried.begin(), tried.end(),
                                 [&](const MeasuredRun* run) { return level(*run) > 1.1 * best; });
  std::vector<Check> checks = {{"own (no network tried makes it 1.1)", own}};
  if (slow != tried.end()) {
    checks = {{"own", own, kAtMost, 1.05},
              {fmt::format("above 1.1 first at, {}", property.unit), property.of((*slow)->machine)}};
  }
  return {"6.4.4; ours",
          on_ranks(fmt::format("The machine's network is good enough in {}", property.experiment), ranks),
          "refinement / that with the best network tried, frames 5-10", checks};
}

Finding repeat(const Runs& runs) {
  const std::vector<int> counts = runs.distinct(kRepeat, &PaperRun::ranks);
  const int ranks = counts.empty() ? 0 : counts.front();
  const std::vector<F>& first = runs.find(kSimple, ranks, kCombined).frames;
  const std::vector<F>& again = runs.find(kRepeat, ranks, kCombined).frames;
  double equal = 0;
  for (std::size_t i = 0; i < std::min(first.size(), again.size()); ++i) {
    equal += first[i].picture_hash == again[i].picture_hash;
  }
  const double frames = again.empty() ? kNoValue : static_cast<double>(again.size());
  return {"ours",
          on_ranks("Two runs under the work clock make the same pictures", ranks),
          "",
          {{"equal frames", equal, kAtLeast, frames, "those of the second run"}}};
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
  Findings all;
  const auto add = [&all](const Findings& more) { all.insert(all.end(), more.begin(), more.end()); };
  const std::vector<int> counts = runs.distinct(kSimple, &PaperRun::ranks);
  for (const int ranks : counts) add(balancing(runs, ranks));
  if (!counts.empty()) add({control(runs, counts.back())});
  for (const std::string_view experiment : {kPattern, kSimple}) {
    for (const int ranks : runs.distinct(experiment, &PaperRun::ranks)) add(pattern(runs, experiment, ranks));
  }
  for (const int side : runs.distinct(kScaling, &PaperRun::side)) add({scaling(runs, side)});
  add({overhead(runs)});
  add(costs(runs));
  add({growth(runs)});
  add(casting(runs));
  add({auto_casting(results.casting_errors)});
  for (const NetworkProperty& property : kNetworkProperties) add({network(runs, property)});
  add({repeat(runs)});
  return all;
}

}  // namespace pprt
