#include "study/paper/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <utility>

#include "study/paper/measures.h"

namespace pprt {
namespace {

constexpr BalanceMode kNone = BalanceMode::kNone, kLocal = BalanceMode::kLocal,
                      kGlobal = BalanceMode::kGlobal, kCombined = BalanceMode::kCombined;
constexpr BalanceMode kModes[] = {kNone, kLocal, kGlobal, kCombined};
constexpr Frames kStart = {1, 10}, kAfterCut = {31, 40};  // of the simple sequence
constexpr Frames kSettled[] = {{5, 10}, {25, 30}, {36, 40}};

double mean_where_settled(const MeasuredRun& run, const Measure& measure) {
  double sum = 0;
  int parts = 0;
  for (const Frames& part : kSettled) {
    if (const double value = mean(run, part, measure); !std::isnan(value)) sum += value, ++parts;
  }
  return parts > 0 ? sum / parts : kNoValue;
}

// What of a criterion is not met.
std::string unmet(std::initializer_list<std::pair<bool, std::string>> conditions) {
  std::string text;
  for (const auto& [met, name] : conditions) {
    if (!met) text += (text.empty() ? "" : "; ") + name;
  }
  return text;
}

std::string frame_count(double frames) {
  return frames == kNever ? "never" : std::isnan(frames) ? "not run" : fmt::format("{:.0f} frames", frames);
}

// A number that was not measured leaves a finding open.
std::optional<bool> judge(bool holds, std::initializer_list<double> of) {
  for (const double value : of) {
    if (std::isnan(value)) return std::nullopt;
  }
  return holds;
}

Finding balancing_beats_none(const Runs& runs, int ranks) {
  const auto level = [&](BalanceMode mode, const Measure& measure) {
    return mean_where_settled(runs.find(kSimple, ranks, mode), measure);
  };
  const double dev[] = {level(kNone, relative_deviation), level(kLocal, relative_deviation),
                        level(kGlobal, relative_deviation), level(kCombined, relative_deviation)};
  const double dist[] = {level(kNone, distance), level(kLocal, distance), level(kGlobal, distance),
                         level(kCombined, distance)};
  std::string worse;
  for (int i = 1; i <= 3; ++i) {
    if (!(dev[i] < dev[0])) worse += fmt::format("{} deviates more; ", to_word(kModes[i]));
    if (!(dist[i] < dist[0])) worse += fmt::format("{} is farther from serial; ", to_word(kModes[i]));
  }
  return {"6.4.1, figures 5b 5c 6b 6c",
          fmt::format("Any load balancing is far better than none ({} ranks)", ranks),
          "Deviation/mean of refinement and distance to serial of local, global and combined below none's, "
          "frames 5-10, 25-30, 36-40",
          fmt::format("deviation/mean: none {:.3f}, local {:.3f}, global {:.3f}, combined {:.3f}; distance: "
                      "none {:.3f}, local {:.3f}, global {:.3f}, combined {:.3f}",
                      dev[0], dev[1], dev[2], dev[3], dist[0], dist[1], dist[2], dist[3]),
          judge(worse.empty(), {dev[0], dev[1], dev[2], dev[3], dist[0], dist[1], dist[2], dist[3]}),
          worse};
}

Finding deviation_is_small(const Runs& runs, int ranks) {
  const double limit = ranks <= 32 ? 0.20 : 0.25;
  double worst = 0;
  std::string parts;
  for (const Frames& part : kSettled) {
    const double value = mean(runs.find(kSimple, ranks, kCombined), part, relative_deviation);
    worst = std::isnan(value) ? value : std::max(worst, value);
    parts += fmt::format("{:.3f} in {}-{}, ", value, part.first, part.last);
  }
  const double none = mean_where_settled(runs.find(kSimple, ranks, kNone), relative_deviation);
  const double combined = mean_where_settled(runs.find(kSimple, ranks, kCombined), relative_deviation);
  return {"ours, after figures 5b 6b",
          fmt::format("With combined balancing all regions are about equally refined ({} ranks)", ranks),
          fmt::format("Deviation/mean at most {:.2f} in frames 5-10, 25-30 and 36-40, and on average at most "
                      "a fifth of none's",
                      limit),
          parts + fmt::format("none {:.3f}", none),
          judge(worst <= limit && combined <= 0.2 * none, {worst, combined, none}),
          unmet({{worst <= limit, "uneven beyond the limit"},
                 {combined <= 0.2 * none, fmt::format("{:.2f} of none's", combined / none)}})};
}

// The criteria of evenness and of the pattern must tell a good run from a bad one.
Finding control(const Runs& runs, int ranks) {
  const MeasuredRun& none = runs.find(kSimple, ranks, kNone);
  const double uneven = mean(none, {5, 10}, relative_deviation), far = mean(none, {5, 10}, distance);
  return {"ours",
          fmt::format("Control: without balancing the measures of evenness and pattern are bad ({} ranks)",
                      ranks),
          "Deviation/mean over 0.25 and distance to serial over 0.10 with none, frames 5-10",
          fmt::format("deviation/mean {:.3f}, distance {:.3f}", uneven, far),
          judge(uneven > 0.25 && far > 0.10, {uneven, far}),
          "so few ranks are even without balancing"};
}

Finding combined_settles_first(const Runs& runs, int ranks, Frames part, const char* when, double within) {
  const MeasuredRun& combined = runs.find(kSimple, ranks, kCombined);
  const double level = 1.5 * mean(combined, {part.last - 3, part.last}, relative_deviation);
  const double fast = frames_to_settle(combined, part, level);
  const double slow = frames_to_settle(runs.find(kSimple, ranks, kLocal), part, level);
  std::string criterion =
      "Combined comes to within 1.5 of its own final deviation/mean in fewer frames than local";
  if (within < kNever) criterion += fmt::format(", and in at most {:.0f}", within);
  return {
      "6.4.1, figures 5b 6b",
      fmt::format("Combined settles faster than local {} ({} ranks)", when, ranks),
      criterion,
      fmt::format("combined: {}; local: {} (down to {:.3f})", frame_count(fast), frame_count(slow), level),
      judge(fast < slow && fast <= within, {level, fast, slow}),
      unmet({{fast < slow, "not before local"},
             {fast <= within,
              "later than asked: what the first uneven frame teaches is in force two frames after it"}})};
}

Finding global_lags(const Runs& runs, int ranks) {
  const MeasuredRun& global = runs.find(kSimple, ranks, kGlobal);
  const double at_cut = mean(global, {31, 31}, relative_deviation);
  const double later = mean(global, {33, 34}, relative_deviation);
  const double combined = mean(runs.find(kSimple, ranks, kCombined), {31, 31}, relative_deviation);
  return {"6.4.1, figures 5b 6b",
          fmt::format("Global answers a cut one or two frames late, and more abruptly ({} ranks)", ranks),
          "At frame 31 global deviates more than combined; in frames 33-34 at most half as much as at 31",
          fmt::format("deviation/mean at 31: global {:.3f}, combined {:.3f}; global in 33-34: {:.3f}", at_cut,
                      combined, later),
          judge(at_cut > combined && later <= 0.5 * at_cut, {at_cut, combined, later}),
          unmet({{at_cut > combined, "combined deviates as much at the cut"},
                 {later <= 0.5 * at_cut, "global has not settled in 33-34"}})};
}

Finding combined_is_cheap(const Runs& runs, int ranks) {
  const MeasuredRun &combined = runs.find(kSimple, ranks, kCombined),
                    &global = runs.find(kSimple, ranks, kGlobal);
  const double dist = mean_where_settled(combined, distance), best = mean_where_settled(global, distance);
  const int cuts = repartitions(combined), all_cuts = repartitions(global);
  const double made = mean(combined, {1, 40}, samples);
  const double local = mean(runs.find(kSimple, ranks, kLocal), {1, 40}, samples);
  return {
      "6.4.1, 6.5",
      fmt::format("Combined is almost as good as global, at little more than local's cost ({} ranks)", ranks),
      "Distance to serial at most 0.03 above global's; at most a third of its repartitions; samples at "
      "least 0.95 of local's",
      fmt::format(
          "distance {:.3f} (global {:.3f}); repartitions {} (global {}); samples {:.0f} (local {:.0f})", dist,
          best, cuts, all_cuts, made, local),
      judge(dist <= best + 0.03 && 3 * cuts <= all_cuts && made >= 0.95 * local, {dist, best, made, local}),
      unmet({{dist <= best + 0.03, "farther from serial"},
             {3 * cuts <= all_cuts, "uneven by more than the trigger, 0.2, in most frames"},
             {made >= 0.95 * local, "fewer samples"}})};
}

Finding none_makes_more_samples(const Runs& runs, int ranks) {
  constexpr Frames kAll = {1, 40};
  const MeasuredRun &none = runs.find(kSimple, ranks, kNone),
                    &combined = runs.find(kSimple, ranks, kCombined);
  const double unbalanced = mean(none, kAll, samples), balanced = mean(combined, kAll, samples);
  return {"6.4.1, figures 5d 6d",
          fmt::format("Without balancing there are more samples, though in worse places ({} ranks)", ranks),
          "More samples a frame with none than with combined",
          fmt::format("none {:.0f}, combined {:.0f}", unbalanced, balanced),
          judge(unbalanced > balanced, {unbalanced, balanced}),
          fmt::format("a sample is taken in by {:.2f} other ranks with combined, by {:.2f} with none",
                      mean(combined, kAll, received_per_sample), mean(none, kAll, received_per_sample))};
}

Finding pattern_is_serial(const Runs& runs, std::string_view experiment, int ranks) {
  constexpr Frames kFrames = {5, 10};
  const double combined = mean(runs.find(experiment, ranks, kCombined), kFrames, distance);
  const double none = mean(runs.find(experiment, ranks, kNone), kFrames, distance);
  const double uneven = mean(runs.find(experiment, ranks, kCombined), kFrames, relative_deviation);
  return {"3.4, figure 2; ours",
          fmt::format("Many ranks leave nearly the serial pattern ({} ranks)", ranks),
          "Distance to serial in frames 5-10 at most 0.10, and at most a quarter of none's",
          fmt::format("combined {:.3f}, none {:.3f}", combined, none),
          judge(combined <= 0.10 && combined <= 0.25 * none, {combined, none}),
          fmt::format("regions differ in refinement: deviation/mean {:.2f}", uneven)};
}

Finding no_strips(const Runs& runs, std::string_view experiment, int ranks) {
  const double density = mean(runs.find(experiment, ranks, kCombined), {5, 10},
                              [](const FrameMeasures& m) { return m.border_density; });
  return {"3.4, figure 2b 2c",
          fmt::format("No strips without samples along borders of regions ({} ranks)", ranks),
          "Within 3 pixels of a border, samples are within 10 % of the serial pattern's there, frames 5-10",
          fmt::format("{:.3f} of the serial pattern's", density),
          judge(std::abs(density - 1) <= 0.1, {density}),
          {}};
}

Finding achievement_is_flat(const Runs& runs, int side, double limit) {
  double least = kNoValue;
  int where = 0;
  std::string values;
  for (const Speedup& s : speedups(runs)) {
    if (s.side != side) continue;
    if (!(s.turned >= least)) least = s.turned, where = s.ranks;
    values += fmt::format("{}{:.3f} on {}", values.empty() ? "" : ", ", s.turned, s.ranks);
  }
  const MeasuredRun& worst = runs.find(kScaling, [&](const PaperRun& run) {
    return run.side == side && run.ranks == where && run.balance == kCombined;
  });
  const double received = mean(worst, {5, 10}, received_per_sample);
  const double uneven = mean(worst, {5, 10}, relative_deviation);
  return {"6.3, 7.1, figure 8",
          fmt::format("A further rank brings as much as those before it, at {0}x{0} pixels", side),
          fmt::format("Refine(1, f/p) / Refine(p, f) at least {:.2f} for every number of ranks", limit),
          values,
          judge(least >= limit, {least}),
          fmt::format(
              "on {} ranks each sample is taken in by {:.2f} others; deviation/mean of refinement is {:.2f}",
              where, received, uneven)};
}

Finding overhead_is_constant(const Runs& runs) {
  const std::vector<int> counts = runs.ranks_of(kScaling);
  const auto ratio = [&](int ranks) {
    const auto of_mode = [&](BalanceMode mode) {
      return mean(runs.find(kScaling, ranks, mode), {5, 10}, samples);
    };
    return of_mode(kCombined) / of_mode(kNone);
  };
  double least = kNoValue, most = kNoValue;
  int where = 0;
  for (const int ranks : counts) {
    if (ranks == 1) continue;
    const double r = ratio(ranks);
    if (!(r >= least)) least = r, where = ranks;
    most = std::isnan(most) || r > most ? r : most;
  }
  return {"6.4.3, figures 8a 8d",
          "Balancing's overhead a rank does not grow with their number",
          "Samples with combined over samples with none: from the least to the greatest ratio at most 0.1",
          fmt::format("{:.3f} to {:.3f} on 2 to {} ranks", least, most, counts.empty() ? 0 : counts.back()),
          judge(most - least <= 0.1, {least, most}),
          fmt::format("the least with p = {}", where)};
}

Finding sampling_dominates(const Runs& runs) {
  double least = kNoValue;
  int where = 0;
  for (const int ranks : runs.ranks_of(kCosts)) {
    const MeasuredRun& run = runs.find(kCosts, ranks, kCombined);
    const double share = mean(run, {1, 10}, [](const FrameMeasures& m) { return m.cpu_ms.sampling; }) /
                         mean(run, {1, 10}, cpu_ms);
    if (!(share >= least)) least = share, where = ranks;
  }
  const double casting = mean(runs.find(kCosts, where, kCombined), {1, 10},
                              [](const FrameMeasures& m) { return m.cpu_ms.casting / cpu_ms(m); });
  return {"6.4.4, figure 9a",
          "Sampling dominates the cost of a frame, on any number of ranks",
          "Sampling takes at least half of the time of all stages",
          fmt::format("least {:.3f}, with p = {}", least, where),
          judge(least >= 0.5, {least}),
          fmt::format("preparation and casting take {:.2f}", casting)};
}

Finding updates_dominate(const Runs& runs) {
  const std::vector<int> counts = runs.ranks_of(kCosts);
  const auto bytes = [&](int ranks, double FrameMeasures::*kind) {
    return mean(runs.find(kCosts, ranks, kCombined), {1, 10},
                [&](const FrameMeasures& m) { return m.*kind; });
  };
  const int most = counts.empty() ? 0 : counts.back();
  const int few = counts.size() > 1 ? counts[counts.size() - 2] : most;
  const double updates = bytes(most, &FrameMeasures::bytes_samples),
               before = bytes(few, &FrameMeasures::bytes_samples);
  const double pixels = bytes(most, &FrameMeasures::bytes_pixels);
  const double balance =
      bytes(most, &FrameMeasures::bytes_balance) + bytes(most, &FrameMeasures::bytes_progress);
  return {
      "6.4.4, figure 9b",
      "Sample updates are most of what is sent, and grow fastest",
      "On the most ranks more bytes of samples than of pixels and than of balancing; more than on half as "
      "many",
      fmt::format("on {} ranks {:.0f} kB a frame of samples, {:.0f} kB of pixels, {:.0f} kB of balancing and "
                  "progress; on {} ranks {:.0f} kB of samples",
                  most, updates / 1e3, pixels / 1e3, balance / 1e3, few, before / 1e3),
      judge(updates > pixels && updates > balance && updates > before, {updates, pixels, balance, before}),
      unmet({{updates > pixels, "pixels are more"},
             {updates > balance, "balancing is more"},
             {updates > before, "no growth"}})};
}

Finding casting_adds_samples(const Runs& runs) {
  const auto with = [&](CastChoice cast) -> const MeasuredRun& {
    return runs.find(kGrowth, [cast](const PaperRun& run) { return run.cast == cast; });
  };
  const MeasuredRun &cast = with(CastChoice::kPaper), &off = with(CastChoice::kOff);
  const double first = mean(cast, {1, 1}, samples), fifth = mean(cast, {5, 5}, samples);
  const double later = mean(cast, {6, 10}, samples), without = mean(off, {5, 10}, samples);
  return {
      "6.4.5, figure 9c",
      "Casting raises the samples over the first five frames, then they level off",
      "Frame 5 has at least 1.1 times the samples of frame 1; frames 6-10 are within 10 % of frame 5",
      fmt::format("{:.0f} at frame 1, {:.0f} at 5, {:.0f} in 6-10; without casting {:.0f}", first, fifth,
                  later, without),
      judge(fifth >= 1.1 * first && std::abs(later - fifth) <= 0.1 * fifth, {first, fifth, later, without}),
      {}};
}

const MeasuredRun& casting_run(const Runs& runs, BalanceMode mode, bool keep) {
  return runs.find(kCasting,
                   [=](const PaperRun& run) { return run.balance == mode && run.keep_samples == keep; });
}

Finding casting_is_balanced(const Runs& runs) {
  constexpr Frames kLater = {5, 40};
  const auto level = [&](BalanceMode mode, const Measure& measure) {
    return mean(casting_run(runs, mode, false), kLater, measure);
  };
  const double dev = level(kCombined, relative_deviation), dist = level(kCombined, distance);
  const double local_dev = level(kLocal, relative_deviation), local_dist = level(kLocal, distance);
  const double none_dev = level(kNone, relative_deviation), none_dist = level(kNone, distance);
  return {"6.4.2, figures 7b 7c",
          "With casting too, combined balances better than local, and local better than none",
          "Deviation/mean and distance to serial in this order, frames 5 to the last",
          fmt::format(
              "deviation/mean: combined {:.3f}, local {:.3f}, none {:.3f}; distance: {:.3f}, {:.3f}, {:.3f}",
              dev, local_dev, none_dev, dist, local_dist, none_dist),
          judge(dev < local_dev && local_dev < none_dev && dist < local_dist && local_dist < none_dist,
                {dev, local_dev, none_dev, dist, local_dist, none_dist}),
          unmet({{dev < local_dev && dist < local_dist, "combined is not better than local"},
                 {local_dev < none_dev && local_dist < none_dist, "local is not better than none"}})};
}

Finding kept_samples_are_balanced(const Runs& runs) {
  constexpr Frames kLater = {5, 40};
  const MeasuredRun& kept = casting_run(runs, kCombined, true);
  const double dropped = mean(casting_run(runs, kCombined, false), kLater, distance);
  const double now = mean(kept, kLater, distance);
  return {"ours, after 6.4.2",
          "Where samples are handed over at a repartition, balance is as good as where they are dropped",
          "Distance to serial at most 0.03 above that with samples dropped, frames 5 to the last",
          fmt::format("kept {:.3f}, dropped {:.3f}", now, dropped),
          judge(now <= dropped + 0.03, {now, dropped}),
          fmt::format("the image was cut anew {} times", repartitions(kept))};
}

std::string loss_text(double loss) {
  return std::isnan(loss) ? "not told: never cut anew" : fmt::format("{:.1f} %", 100 * loss);
}

Finding repartition_drops_samples(const Runs& runs) {
  const auto loss_with = [&](bool keep) { return worst_loss(casting_run(runs, kCombined, keep)); };
  const double dropped = loss_with(false), kept = loss_with(true);
  return {"6.4.2, figures 7a 7d; ours",
          "A repartition that drops the samples cast costs a frame its samples; handing them over does not",
          "At a repartition at least 10 % fewer samples than in the frame before when dropped, at most 5 % "
          "when kept",
          fmt::format("greatest loss: dropped {}, kept {}", loss_text(dropped), loss_text(kept)),
          judge(dropped >= 0.10 && kept <= 0.05, {dropped, kept}),
          {}};
}

Finding auto_casting_is_best(const std::vector<CastErrors>& errors) {
  constexpr double kLimit = 1.02;
  double worst = errors.empty() ? kNoValue : 0;
  std::string measured, beyond;
  for (const CastErrors& e : errors) {
    const double ratio = e.auto_ratio();
    const std::string text = fmt::format("{} at speed {:g}, {:g} a pixel: {:.3f}; ", e.sequence.scene,
                                         e.sequence.speed, e.samples_per_pixel, ratio);
    worst = std::max(worst, ratio);
    measured += text;
    if (ratio > kLimit) beyond += text;
  }
  return {"ours",
          "Judged by true error, auto is never worse than off, paper and verified",
          "Mean RMSE with auto at most 1.02 of the best of the others', in every sequence",
          measured + fmt::format("worst {:.3f}", worst),
          judge(worst <= kLimit, {worst}),
          beyond};
}

Finding repeats(const Runs& runs) {
  const std::vector<int> counts = runs.ranks_of(kRepeat);
  const int ranks = counts.empty() ? 0 : counts.front();
  const MeasuredRun &first = runs.find(kSimple, ranks, kCombined),
                    &again = runs.find(kRepeat, ranks, kCombined);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < std::min(first.frames.size(), again.frames.size()); ++i) {
    equal += first.frames[i].picture_hash == again.frames[i].picture_hash;
  }
  return {"ours",
          fmt::format("Two runs under the work clock make the same pictures ({} ranks)", ranks),
          "Every frame of the second run has the bits of the first's",
          fmt::format("{} of {} frames", equal, again.frames.size()),
          again.frames.empty() ? std::nullopt : std::optional(equal == again.frames.size()),
          {}};
}

// The network's part in one run's refinement, and where it begins to hurt: at the first of the values tried
// that makes refinement more than a tenth worse than the first value, the best.
Finding network_is_good_enough(const Runs& runs, std::string_view experiment, const char* what,
                               const std::function<std::string(const Machine&)>& text) {
  const auto of_run = [](const MeasuredRun& run) { return mean(run, {5, 10}, refinement); };
  const std::vector<int> counts = runs.ranks_of(experiment);
  const int ranks = counts.empty() ? 0 : counts.back();
  const double own = of_run(runs.find(kSimple, ranks, kCombined));
  double best = kNoValue;
  std::string hurts;
  for (const MeasuredRun* run : runs.all(experiment)) {
    const double value = of_run(*run);
    if (std::isnan(best)) best = value;
    if (value <= 1.1 * best) continue;
    hurts = text(run->run.machine);
    break;
  }
  return {"6.4.4; ours",
          fmt::format("The machine's network is good enough in {} ({} ranks)", what, ranks),
          "Refinement at most 5 % worse than with the best network tried; it hurts where it makes 10 %. Open "
          "when none of those tried hurts",
          fmt::format("{:.1f} % worse; hurts at {}", 100 * (own / best - 1),
                      hurts.empty() ? "none tried" : hurts),
          hurts.empty() ? std::nullopt : judge(own <= 1.05 * best, {own, best}),
          {}};
}

}  // namespace

std::vector<Finding> findings(const PaperResults& results) {
  const Runs runs(results);
  std::vector<Finding> all;
  for (const int ranks : runs.ranks_of(kSimple)) {
    all.push_back(balancing_beats_none(runs, ranks));
    all.push_back(deviation_is_small(runs, ranks));
    all.push_back(combined_settles_first(runs, ranks, kStart, "at the start", kNever));
    all.push_back(combined_settles_first(runs, ranks, kAfterCut, "after the cut", 3));
    all.push_back(global_lags(runs, ranks));
    all.push_back(combined_is_cheap(runs, ranks));
    all.push_back(none_makes_more_samples(runs, ranks));
  }
  if (const std::vector<int> counts = runs.ranks_of(kSimple); !counts.empty()) {
    all.push_back(control(runs, counts.back()));
  }
  for (const std::string_view experiment : {kPattern, kSimple}) {
    for (const int ranks : runs.ranks_of(experiment)) {
      all.push_back(pattern_is_serial(runs, experiment, ranks));
      all.push_back(no_strips(runs, experiment, ranks));
    }
  }
  for (const int side : runs.sides_of(kScaling)) {
    all.push_back(achievement_is_flat(runs, side, side >= 2 * kPaperSide ? 0.90 : 0.85));
  }
  all.push_back(overhead_is_constant(runs));
  all.push_back(sampling_dominates(runs));
  all.push_back(updates_dominate(runs));
  all.push_back(casting_adds_samples(runs));
  all.push_back(casting_is_balanced(runs));
  all.push_back(repartition_drops_samples(runs));
  all.push_back(kept_samples_are_balanced(runs));
  all.push_back(auto_casting_is_best(results.cast_errors));
  all.push_back(network_is_good_enough(runs, kLatency, "latency", [](const Machine& machine) {
    return fmt::format("{:.4g} microseconds", 1e6 * machine.latency_s);
  }));
  all.push_back(network_is_good_enough(runs, kBandwidth, "bandwidth", [](const Machine& machine) {
    return fmt::format("{:.4g} MB/s", 1e-6 * machine.bytes_per_second);
  }));
  all.push_back(repeats(runs));
  for (Finding& finding : all) {
    if (finding.holds.value_or(true)) finding.why_not.clear();
    if (!finding.holds && finding.measured.find("nan") != std::string::npos) {
      finding.measured = "the frames for it were not run";
    }
  }
  return all;
}

}  // namespace pprt
