#include "study/paper/paper_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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
  Measure measure;
};

// The paper's four measures, and two of ours. The last is one of two.
const std::vector<Quantity> kOverFrames = {
    {"(a) Refinement, mean over ranks", "weight", &F::refinement},
    {"(b) Deviation of refinement over ranks", "weight", &F::refinement_deviation},
    {"(c) Distance to the serial pattern", "share of samples", &F::distance},
    {"(d) Samples", "samples per frame", &F::samples},
    {"Deviation / mean of refinement", "ratio", relative_deviation}};
const Quantity kSamplesCast = {"Samples cast from the frame before", "samples per frame", &F::samples_cast};
const Quantity kReceived = {"Samples received from other ranks", "share of the frame's samples",
                            received_per_sample};

const std::vector<Quantity> kOverRanks = {
    {"(a) Refinement, mean over ranks", "weight", &F::refinement},
    {"(b) Deviation / mean of refinement", "ratio", relative_deviation},
    {"(c) Distance to the serial pattern", "share of samples", &F::distance},
    {"(d) Samples", "samples per frame", &F::samples}};

const std::vector<std::pair<const char*, Measure>> kStages = {
    {"sampling", [](const F& m) { return m.cpu_ms.sampling; }},
    {"casting", [](const F& m) { return m.cpu_ms.casting; }},
    {"reconstruction", [](const F& m) { return m.cpu_ms.reconstruction; }},
    {"balancing", [](const F& m) { return m.cpu_ms.balancing; }}};
const std::vector<std::pair<const char*, Measure>> kKilobytes = {
    {"samples", [](const F& m) { return 1e-3 * static_cast<double>(m.bytes.samples); }},
    {"pixels", [](const F& m) { return 1e-3 * static_cast<double>(m.bytes.pixels); }},
    {"balancing", [](const F& m) { return 1e-3 * static_cast<double>(m.bytes.balance); }},
    {"progress", [](const F& m) { return 1e-3 * static_cast<double>(m.bytes.progress); }}};

int ranks_of(const MeasuredRun* run) {
  return run->run.ranks;
}

auto mean_over(Frames frames, const Measure& measure) {
  return [=](const MeasuredRun* run) { return mean(*run, frames, measure); };
}

int colour_of(BalanceMode mode) {
  return static_cast<int>(mode);
}

// A run with its name in the legend.
struct Series {
  std::string name;
  const MeasuredRun* run;
  int colour;

  Curve over_frames(const Measure& measure) const {
    return curve_over(name, run->frames, &F::number, measure, CurveStyle::kLine, colour);
  }
};

Panel frame_panel(const Quantity& quantity, const std::vector<Series>& series) {
  Panel panel{quantity.title, {"frame"}, {quantity.unit, 0, 0}, {}, PanelKind::kCurves};
  for (const Series& s : series) panel.curves.push_back(s.over_frames(quantity.measure));
  for (const Series& s : series) {
    if (s.run->run.balance != BalanceMode::kCombined) continue;
    std::vector<F> frames = s.run->frames;
    std::erase_if(frames, [](const F& m) { return !m.repartitioned; });
    panel.curves.push_back(
        curve_over("", frames, &F::number, quantity.measure, CurveStyle::kMarks, s.colour));
  }
  return panel;
}

// Figures 5 to 7.
Plot sequence_plot(std::string name, const std::vector<Series>& series, const Quantity& last) {
  Plot plot{std::move(name), {}, 2};
  for (const Quantity& quantity : kOverFrames) plot.panels.push_back(frame_panel(quantity, series));
  plot.panels.push_back(frame_panel(last, series));
  return plot;
}

Plot simple_plot(const Runs& runs, int ranks) {
  std::vector<Series> series;
  for (const auto& [mode, word, help] : kWords<BalanceMode>) {
    series.push_back({std::string(word), &runs.find(kSimple, ranks, mode), colour_of(mode)});
  }
  return sequence_plot(fmt::format("simple-{}", ranks), series, kReceived);
}

Plot casting_plot(const Runs& runs) {
  std::vector<Series> series;
  for (const MeasuredRun* run : runs.all(kCasting)) {
    const BalanceMode mode = run->run.balance;
    const bool kept = mode == BalanceMode::kCombined && run->run.keep_samples;
    series.push_back({std::string(word_for(mode)) + (kept ? ", kept" : ""), run,
                      kept ? static_cast<int>(kWords<BalanceMode>.size()) : colour_of(mode)});
  }
  return sequence_plot("casting", series, kSamplesCast);
}

Panel ranks_panel(const Runs& runs, const Quantity& quantity) {
  Panel panel{quantity.title, {"ranks", 2}, {quantity.unit, 0, 0}, {}, PanelKind::kCurves};
  const std::vector<int> sides = runs.sides_of(kScaling);
  for (const Word<BalanceMode>& mode : kWords<BalanceMode>) {
    const RunPointers chosen = runs.all(kScaling, [&](const PaperRun& run) {
      return run.balance == mode.value && run.side == sides.front();
    });
    if (chosen.empty()) continue;
    panel.curves.push_back(curve_over(std::string(mode.word), chosen, ranks_of,
                                      mean_over(kStill, quantity.measure), CurveStyle::kMarkedLine,
                                      colour_of(mode.value)));
  }
  return panel;
}

Panel speedup_panel(const Runs& runs, const char* title, double Speedup::*value, const Axis& y,
                    const std::function<double(int)>& ideal) {
  Panel panel{title, {"ranks", 2}, y, {}, PanelKind::kCurves};
  for (const int side : runs.sides_of(kScaling)) {
    std::vector<Speedup> of_side = speedups(runs);
    std::erase_if(of_side, [&](const Speedup& s) { return s.side != side; });
    panel.curves.push_back(
        curve_over(fmt::format("{0}x{0}", side), of_side, &Speedup::ranks, value, CurveStyle::kMarkedLine));
  }
  const auto same = [](int ranks) { return ranks; };
  panel.curves.push_back(curve_over("ideal", runs.ranks_of(kScaling), same, ideal, CurveStyle::kReference));
  return panel;
}

Plot scaling_plot(const Runs& runs) {
  Plot plot{"scaling", {}, 2};
  for (const Quantity& quantity : kOverRanks) plot.panels.push_back(ranks_panel(runs, quantity));
  const char* label = "AchievementSpeedup";
  plot.panels.push_back(speedup_panel(runs, "Refine(1, f/p) / Refine(p, f)", &Speedup::same_work,
                                      {label, 0, 0}, [](int) { return 1; }));
  plot.panels.push_back(speedup_panel(runs, "Refine(1, f) / Refine(p, f)", &Speedup::same_frame, {label, 2},
                                      [](int ranks) { return ranks; }));
  return plot;
}

Panel bars_panel(const Runs& runs, const char* title, const char* unit,
                 const std::vector<std::pair<const char*, Measure>>& parts) {
  Panel panel{title, {"ranks"}, {unit, 0, 0}, {}, PanelKind::kStackedBars};
  for (const auto& [name, measure] : parts) {
    panel.curves.push_back(curve_over(name, runs.all(kCosts), ranks_of, mean_over(kStart, measure)));
  }
  return panel;
}

Panel growth_panel(const Runs& runs) {
  Panel panel{"(c) Casting on one rank", {"frame"}, {"samples per frame", 0, 0}, {}, PanelKind::kCurves};
  for (const MeasuredRun* run : runs.all(kGrowth)) {
    const bool cast = run->run.cast != CastChoice::kOff;
    panel.curves.push_back(
        Series{cast ? "with cast" : "no cast", run, cast ? 1 : 0}.over_frames(&F::samples));
    if (cast) panel.curves.push_back(Series{"samples cast", run, 2}.over_frames(&F::samples_cast));
  }
  return panel;
}

Panel network_panel(const Runs& runs, std::string_view experiment, const char* title, const char* unit,
                    const std::function<double(const Machine&)>& value) {
  Panel panel{title, {unit, 10}, {"refinement / the best tried"}, {}, PanelKind::kCurves};
  RunPointers tried = runs.all(experiment);
  const auto refinement = mean_over(kStill, &F::refinement);
  const double best = tried.empty() ? kNoValue : refinement(tried.front());
  std::erase_if(tried, [&](const MeasuredRun* run) { return value(run->run.machine) <= 0; });
  panel.curves.push_back(curve_over(
      "", tried, [&](const MeasuredRun* run) { return value(run->run.machine); },
      [&](const MeasuredRun* run) { return refinement(run) / best; }, CurveStyle::kMarkedLine));
  return panel;
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
  std::vector<Speedup> all = speedups(runs);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.side < b.side; });
  return table_of<Speedup>(all, {{"side [pixels]", &Speedup::side},
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
      "that it makes about {:.0f} samples at {} x {} pixels: {:.3g} units on {} ranks, {:.3g} on {}. Where "
      "the number of ranks varies (figures 8 and 9) all do the work of {} ranks. Each rank does {:.3g} units "
      "per second. A message takes {:.3g} microseconds, and each rank's link carries {:.4g} MB/s. On {} "
      "ranks a frame lasts {:.3g} ms.",
      kPaperSamples, kPaperSide, kPaperSide, calibration.total_units, first,
      calibration.total_units * calibration.share.at(last), last, first, machine.units_per_second,
      1e6 * machine.latency_s, 1e-6 * machine.bytes_per_second, last, 1e3 * calibration.frame_s);
}

void write_figures(const Runs& runs, const PaperResults& results, const PaperOptions& options,
                   StudyOutput& output) {
  Page& page = output.page();
  int figure = 5;
  for (const int ranks : options.ranks) {
    page.heading(fmt::format("Balancing on {} ranks (the paper's figure {})", ranks, figure++));
    output.add_figure(simple_plot(runs, ranks),
                      "The simple sequence, without casting. Triangles: repartitions of combined balancing.");
  }
  const int ranks = options.ranks.back();
  page.heading("Casting (the paper's figure 7)");
  output.add_figure(casting_plot(runs),
                    fmt::format("The casting sequence on {} ranks, samples cast as in the paper. \"Kept\": "
                                "at a repartition samples go to their new owners. The paper drops them.",
                                ranks));
  page.heading("True error of the ways of casting");
  page.paragraph(casting_trial_text(casting_trial(options)));
  output.add_table("casting-errors", casting_errors_table(results.casting_errors));
  page.heading("Number of ranks (the paper's figure 8)");
  output.add_figure(
      scaling_plot(runs),
      "Means over frames 5 to 10 of the simple sequence. The work of all ranks together is constant.");
  output.add_table("speedup", speedup_table(runs));
  page.heading("Costs (the paper's figure 9)");
  output.add_figure(
      {"costs",
       {bars_panel(runs, "(a) Time by stage, all ranks", "ms of work per frame", kStages),
        bars_panel(runs, "(b) Bytes by kind, all ranks", "kB per frame", kKilobytes), growth_panel(runs)},
       2},
      "The first ten frames of the casting sequence, combined balancing. On the work clock the decisions of "
      "balancing have no price; the samples that it moves count as sampling.");
  page.heading("Where communication begins to hurt");
  output.add_figure(
      {"network",
       {network_panel(runs, kLatency, "Latency", "microseconds",
                      [](const Machine& m) { return 1e6 * m.latency_s; }),
        network_panel(runs, kBandwidth, "Bandwidth of each rank", "MB/s",
                      [](const Machine& m) { return 1e-6 * m.bytes_per_second; })},
       2},
      fmt::format("The simple sequence on {} ranks, combined balancing. 1: the best network tried.", ranks));
}

}  // namespace

Table frames_table(const PaperResults& results) {
  struct Row {
    const PaperRun& run;
    const F& frame;
  };
  std::vector<Row> rows;
  for (const MeasuredRun& run : results.runs) {
    for (const F& frame : run.frames) rows.push_back({run.run, frame});
  }
  using Run = PaperRun;
  const auto word = [](auto member) {
    return [=](const Row& row) { return std::string(std::invoke(member, row.run)); };
  };
  const auto of_run = [](auto member) {
    return [=](const Row& row) { return std::invoke(member, row.run); };
  };
  const auto of_frame = [](const Measure& measure) {
    return [=](const Row& row) { return measure(row.frame); };
  };
  return table_of<Row>(
      rows, {{"experiment", word(&Run::experiment)},
             {"sequence", word(&Run::sequence)},
             {"ranks", of_run(&Run::ranks)},
             {"side [pixels]", of_run(&Run::side)},
             {"balance", word([](const Run& run) { return word_for(run.balance); })},
             {"cast", word([](const Run& run) { return word_for(run.cast); })},
             {"keep samples", word([](const Run& run) { return word_for(run.keep_samples); })},
             {"share of work", of_run(&Run::share)},
             {"latency [s]", of_run([](const Run& run) { return run.machine.latency_s; })},
             {"bandwidth [bytes/s]", of_run([](const Run& run) { return run.machine.bytes_per_second; })},
             {"frame", of_frame(&F::number)},
             {"refinement", of_frame(&F::refinement)},
             {"deviation", of_frame(&F::refinement_deviation)},
             {"distance to serial", of_frame(&F::distance)},
             {"density at borders", of_frame(&F::border_density)},
             {"samples", of_frame(&F::samples)},
             {"samples cast", of_frame(&F::samples_cast)},
             {"samples received", of_frame(&F::samples_received)},
             {"repartitioned", of_frame(&F::repartitioned)},
             {"late [ms]", of_frame(&F::late_ms)},
             {"sampling [ms]", of_frame([](const F& m) { return m.cpu_ms.sampling; })},
             {"casting [ms]", of_frame([](const F& m) { return m.cpu_ms.casting; })},
             {"reconstruction [ms]", of_frame([](const F& m) { return m.cpu_ms.reconstruction; })},
             {"balancing [ms]", of_frame([](const F& m) { return m.cpu_ms.balancing; })},
             {"idle [ms]", of_frame([](const F& m) { return m.cpu_ms.idle; })},
             {"sample bytes", of_frame([](const F& m) { return m.bytes.samples; })},
             {"progress bytes", of_frame([](const F& m) { return m.bytes.progress; })},
             {"balance bytes", of_frame([](const F& m) { return m.bytes.balance; })},
             {"pixel bytes", of_frame([](const F& m) { return m.bytes.pixels; })},
             {"picture hash", [](const Row& row) { return row.frame.picture_hash; }}});
}

void study_paper(const PaperOptions& asked, const std::string& command_line) {
  const PaperOptions options = settled(asked);
  StudyOutput output(options.directory, "The paper's experiments",
                     {{"command", command_line}, {"seed", std::to_string(options.seed)}});
  const PaperResults results =
      run_paper(options, [](const std::string& line) { fmt::print(stderr, "pprt-study: {}\n", line); });
  output.write_table("frames", frames_table(results));
  Page& page = output.page();
  page.paragraph(kPaperReference);
  page.paragraph(setup_text(results, options));
  if (options.quick) page.note(kQuickNote);
  page.heading("Findings");
  output.add_table("findings", findings_table(findings(results)));
  write_figures(Runs(results), results, options, output);
  page.heading("Sample patterns (the paper's figures 1 and 2)");
  output.add_gallery(results.pattern_pictures);
  page.heading("Frames, patterns and regions (the paper's figure 4)");
  output.add_gallery(results.sequence_pictures);
  output.finish();
}

}  // namespace pprt
