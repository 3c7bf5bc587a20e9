#include "study/paper/paper_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "study/paper/findings.h"
#include "study/paper/measures.h"
#include "study/report/output.h"

namespace pprt {
namespace {

using F = FrameMeasures;
using RunPointers = std::vector<const MeasuredRun*>;

constexpr const char* kQuickNote =
    "A quick trial: small pictures of a small tree on few ranks, and the first frames only. It shows that "
    "the study works. Its findings are not the paper's.";

constexpr const char* kPaperReference =
    "The experiments of Reisman, Gotsman and Schuster, Interactive-Rate Animation Generation by Parallel "
    "Progressive Ray-Tracing on Distributed-Memory Machines, J. Parallel Distrib. Comput. 60 (2000), section "
    "6.";

// What is drawn in one panel.
struct Quantity {
  const char* title;
  const char* unit;
  FrameMeasure measure;
};

// The paper's four measures, and two of ours. The last is one of two.
const std::vector<Quantity> kOverFrames = {
    {"(a) Refinement, mean over ranks", "weight", &F::mean_weight},
    {"(b) Deviation of refinement over ranks", "weight", &F::mean_weight_deviation},
    {"(c) Distance to the serial pattern", "share of samples", &F::distance},
    {"(d) Samples", "samples per frame", &F::samples},
    {"Deviation / mean of refinement", "ratio", relative_deviation}};
const Quantity kSamplesCast = {"Samples cast from the frame before", "samples per frame", &F::samples_cast};
const Quantity kReceived = {"Samples received from other ranks", "share of the frame's samples",
                            received_per_sample};

const std::vector<Quantity> kOverRanks = {kOverFrames[0],
                                          {"(b) Deviation / mean of refinement", "ratio", relative_deviation},
                                          kOverFrames[2],
                                          kOverFrames[3]};

// What a bar is made of, with names.
using Parts = std::vector<std::pair<const char*, FrameMeasure>>;
const Parts kStages = {{"sampling", time_of(&StageTimes::sampling)},
                       {"casting", time_of(&StageTimes::casting)},
                       {"reconstruction", time_of(&StageTimes::reconstruction)},
                       {"balancing", time_of(&StageTimes::balancing)}};
const Parts kKilobytes = {{"samples", kilobytes_of(&BytesSent::samples)},
                          {"pixels", kilobytes_of(&BytesSent::pixels)},
                          {"balancing", kilobytes_of(&BytesSent::balance)},
                          {"progress", kilobytes_of(&BytesSent::progress)}};

Axis from_zero(const char* label) {
  return {label, 0, 0};
}

auto mean_over(Frames frames, const FrameMeasure& measure) {
  return [=](const MeasuredRun* run) { return mean(*run, frames, measure); };
}

// A run with its name in the legend.
struct Series {
  std::string name;
  const MeasuredRun* run;
  int colour;

  Curve over_frames(const FrameMeasure& measure) const {
    return curve_over(name, run->frames, &F::number, measure, CurveStyle::kLine, colour);
  }
};

Panel frame_panel(const Quantity& quantity, const std::vector<Series>& series) {
  Panel panel{quantity.title, {"frame"}, from_zero(quantity.unit)};
  for (const Series& s : series) panel.curves.push_back(s.over_frames(quantity.measure));
  for (const Series& s : series) {
    if (s.run->balance != BalanceMode::kCombined) continue;
    std::vector<F> frames = s.run->frames;
    std::erase_if(frames, [](const F& m) { return !m.repartitioned; });
    panel.curves.push_back(
        curve_over("", frames, &F::number, quantity.measure, CurveStyle::kMarks, s.colour));
  }
  return panel;
}

// Figures 5 to 7. A colour for each mode of balancing, and one for samples that are kept.
Plot sequence_plot(const std::string& name, const RunPointers& runs, const Quantity& last) {
  std::vector<Series> series;
  for (const MeasuredRun* run : runs) {
    const bool kept = run->cast != CastChoice::kOff && run->keep_samples;
    series.push_back({std::string(word_for(run->balance)) + (kept ? ", kept" : ""), run,
                      static_cast<int>(kept ? kWords<BalanceMode>.size() : std::size_t(run->balance))});
  }
  Plot plot{name};
  for (const Quantity& quantity : kOverFrames) plot.panels.push_back(frame_panel(quantity, series));
  plot.panels.push_back(frame_panel(last, series));
  return plot;
}

Panel ranks_panel(const Runs& runs, const Quantity& quantity) {
  Panel panel{quantity.title, {"ranks", 2}, from_zero(quantity.unit)};
  const int side = runs.distinct(kScaling, &PaperRun::side).front();
  for (const auto& [mode, word, help] : kWords<BalanceMode>) {
    const RunPointers chosen = runs.all(kScaling, [&, balance = mode](const PaperRun& run) {
      return run.balance == balance && run.side == side;
    });
    if (chosen.empty()) continue;
    panel.curves.push_back(curve_over(std::string(word), chosen, &MeasuredRun::ranks,
                                      mean_over(kStill, quantity.measure), CurveStyle::kMarkedLine,
                                      static_cast<int>(mode)));
  }
  return panel;
}

Panel speedup_panel(const Runs& runs, const char* title, double Speedup::*value, const Axis& y,
                    const std::function<double(int)>& ideal) {
  Panel panel{title, {"ranks", 2}, y};
  for (const int side : runs.distinct(kScaling, &PaperRun::side)) {
    std::vector<Speedup> of_side = speedups(runs);
    std::erase_if(of_side, [&](const Speedup& s) { return s.side != side; });
    panel.curves.push_back(
        curve_over(fmt::format("{0}x{0}", side), of_side, &Speedup::ranks, value, CurveStyle::kMarkedLine));
  }
  panel.curves.push_back(curve_over("ideal", runs.distinct(kScaling, &PaperRun::ranks), std::identity(),
                                    ideal, CurveStyle::kReference));
  return panel;
}

Plot scaling_plot(const Runs& runs) {
  Plot plot{"scaling"};
  for (const Quantity& quantity : kOverRanks) plot.panels.push_back(ranks_panel(runs, quantity));
  const char* label = "AchievementSpeedup";
  plot.panels.push_back(speedup_panel(runs, "Refine(1, f/p) / Refine(p, f)", &Speedup::same_work,
                                      from_zero(label), [](int) { return 1; }));
  plot.panels.push_back(
      speedup_panel(runs, "Refine(1, f) / Refine(p, f)", &Speedup::same_frame, {label, 2}, std::identity()));
  return plot;
}

Panel bars_panel(const Runs& runs, const char* title, const char* unit, const Parts& parts) {
  Panel panel{title, {"ranks"}, from_zero(unit), {}, PanelKind::kStackedBars};
  for (const auto& [name, measure] : parts) {
    panel.curves.push_back(
        curve_over(name, runs.all(kCosts), &MeasuredRun::ranks, mean_over(kStart, measure)));
  }
  return panel;
}

Panel growth_panel(const Runs& runs) {
  Panel panel{"(c) Casting on one rank", {"frame"}, from_zero("samples per frame")};
  for (const MeasuredRun* run : runs.all(kGrowth)) {
    const bool cast = run->cast != CastChoice::kOff;
    panel.curves.push_back(
        Series{cast ? "with cast" : "no cast", run, cast ? 1 : 0}.over_frames(&F::samples));
    if (cast) panel.curves.push_back(Series{"samples cast", run, 2}.over_frames(&F::samples_cast));
  }
  return panel;
}

Panel network_panel(const Runs& runs, const NetworkProperty& property) {
  RunPointers tried = runs.all(property.experiment);
  const auto refinement = mean_over(kStill, &F::mean_weight);
  const double best = tried.empty() ? kNoValue : refinement(tried.front());
  const auto value = [&](const MeasuredRun* run) { return property.of(run->machine); };
  std::erase_if(tried, [&](const MeasuredRun* run) { return value(run) <= 0; });
  return {property.title,
          {property.unit, 10},
          {"refinement / the best tried"},
          {curve_over(
              "", tried, value, [&](const MeasuredRun* run) { return refinement(run) / best; },
              CurveStyle::kMarkedLine)}};
}

std::vector<Finding> with_verdict(const std::vector<Finding>& all, std::optional<bool> verdict) {
  std::vector<Finding> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
               [&](const Finding& f) { return f.holds() == verdict; });
  return chosen;
}

// What fits a screen above the figures: how many findings hold, and which do not.
void write_summary(const std::vector<Finding>& all, StudyOutput& output) {
  const std::vector<Finding> refuted = with_verdict(all, false);
  output.section("Summary", fmt::format("{} of {} findings hold, {} do not, {} were not measured.",
                                        with_verdict(all, true).size(), all.size(), refuted.size(),
                                        with_verdict(all, std::nullopt).size()));
  if (refuted.empty()) return;
  output.table(
      table_of<Finding>(refuted, {{"does not hold", &Finding::claim}, {"section", &Finding::source}}));
}

Table findings_table(const std::vector<Finding>& all) {
  const auto verdict = [](const Finding& f) {
    return !f.holds() ? "not measured" : *f.holds() ? "holds" : "does not hold";
  };
  Table table = table_of<Finding>(all, {{"finding", &Finding::claim},
                                        {"holds", verdict},
                                        {"measured", &Finding::measured},
                                        {"criterion", &Finding::criterion},
                                        {"why not", &Finding::why_not},
                                        {"section", &Finding::source}});
  for (const Finding& f : all) {
    table.tones.push_back(!f.holds() ? Tone::kPlain : *f.holds() ? Tone::kGood : Tone::kBad);
  }
  return table;
}

Table speedup_table(const Runs& runs) {
  return table_of<Speedup>(speedups(runs), {{"side [pixels]", &Speedup::side},
                                            {"ranks", &Speedup::ranks},
                                            {"Refine(1, f/p) / Refine(p, f)", &Speedup::same_work},
                                            {"Refine(1, f) / Refine(p, f)", &Speedup::same_frame}});
}

std::string setup_text(const PaperResults& results, const PaperOptions& options) {
  const Machine machine = machine_of(options);
  const Calibration& calibration = results.calibration;
  const int first = options.ranks.front(), last = options.ranks.back();
  return fmt::format(
      "All ranks are threads of one process under the work clock, which counts work instead of seconds: the "
      "results are the same on any computer. Calibration sets the work of a frame, all ranks together, so "
      "that it makes about {:.0f} samples at {} x {} pixels: {:.3g} units on {}, {:.3g} on {}. Where "
      "the number of ranks varies (figures 8 and 9) all do the work of {}. Each rank does {:.3g} units "
      "per second. A message takes {:.3g} microseconds, and each rank's link carries {:.4g} MB/s. On {} "
      "a frame lasts {:.3g} ms.",
      kPaperSamples, kPaperSide, kPaperSide, calibration.total_units, counted(first, "rank", "ranks"),
      calibration.total_units * calibration.share.at(last), last, counted(first, "rank", "ranks"),
      machine.units_per_second, 1e6 * machine.latency_s, 1e-6 * machine.bytes_per_second,
      counted(last, "rank", "ranks"), 1e3 * calibration.frame_s);
}

void write_figures(const Runs& runs, const PaperResults& results, const PaperOptions& options,
                   StudyOutput& output) {
  int figure = 5;
  for (const int ranks : options.ranks) {
    const auto on_ranks = [=](const PaperRun& run) { return run.ranks == ranks; };
    output.heading(
        fmt::format("Balancing on {} (the paper's figure {})", counted(ranks, "rank", "ranks"), figure++));
    output.add_figure(sequence_plot(fmt::format("simple-{}", ranks), runs.all(kSimple, on_ranks), kReceived),
                      "The simple sequence, without casting. Triangles: repartitions of combined balancing.");
  }
  const int ranks = options.ranks.back();
  output.heading("Casting (the paper's figure 7)");
  output.add_figure(sequence_plot("casting", runs.all(kCasting), kSamplesCast),
                    fmt::format("The casting sequence on {}, samples cast as in the paper. \"Kept\": "
                                "at a repartition samples go to their new owners. The paper drops them.",
                                counted(ranks, "rank", "ranks")));
  output.section("True error of the ways of casting", casting_trial_text(casting_trial(options)));
  output.add_table("casting-errors", casting_errors_table(results.casting_errors));
  output.heading("Number of ranks (the paper's figure 8)");
  output.add_figure(
      scaling_plot(runs),
      "Means over frames 5 to 10 of the simple sequence. The work of all ranks together is constant.");
  output.add_table("speedup", speedup_table(runs));
  output.heading("Costs (the paper's figure 9)");
  output.add_figure(
      {"costs",
       {bars_panel(runs, "(a) Time by stage, all ranks", "ms of work per frame", kStages),
        bars_panel(runs, "(b) Bytes by kind, all ranks", "kB per frame", kKilobytes), growth_panel(runs)}},
      "The first ten frames of the casting sequence, combined balancing. On the work clock the decisions of "
      "balancing have no price; the samples that it moves count as sampling.");
  output.heading("Where communication begins to hurt");
  Plot network{"network"};
  for (const NetworkProperty& property : kNetworkProperties) {
    network.panels.push_back(network_panel(runs, property));
  }
  output.add_figure(network,
                    fmt::format("The simple sequence on {}, combined balancing. 1: the best network tried.",
                                counted(ranks, "rank", "ranks")));
}

}  // namespace

void study_paper(const PaperOptions& asked, const std::string& command_line) {
  const PaperOptions options = settled(asked);
  StudyOutput output(options.directory, "The paper's experiments",
                     {{"command", command_line},
                      {"seed", std::to_string(options.seed)},
                      {"weights", std::string(word_for(options.weights))}});
  const PaperResults results =
      run_paper(options, [](const std::string& line) { fmt::print(stderr, "pprt-study: {}\n", line); });
  output.write_table("frames", frames_table(results));
  if (options.quick) output.note(kQuickNote);
  output.paragraph(kPaperReference);
  const std::vector<Finding> all = findings(results);
  write_summary(all, output);
  write_figures(Runs(results), results, options, output);
  output.heading("Sample patterns (the paper's figures 1 and 2)");
  output.add_gallery(results.pattern_pictures);
  output.heading("Frames, patterns and regions (the paper's figure 4)");
  output.add_gallery(results.sequence_pictures);
  output.heading("Findings");
  output.add_table("findings", findings_table(all));
  output.section("How this was measured", setup_text(results, options));
  output.finish();
}

}  // namespace pprt
