#include "study/paper/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "study/paper/findings.h"
#include "study/paper/measures.h"

namespace pprt {
namespace {

constexpr std::array kModes = {BalanceMode::kNone, BalanceMode::kLocal, BalanceMode::kGlobal,
                               BalanceMode::kCombined};

// A run under the name that it has in a legend.
struct Named {
  std::string name;
  const MeasuredRun* run;
  int colour;
};

Curve over_frames(const Named& of, const Measure& measure) {
  Curve curve{of.name, {}, CurveStyle::kLine, of.colour};
  for (const FrameMeasures& m : of.run->frames) curve.points.push_back({1.0 * m.frame, measure(m)});
  return curve;
}

// Where the combined algorithm cut the image anew, as the paper marks it.
Curve repartition_marks(const Named& of, const Measure& measure) {
  Curve curve{"", {}, CurveStyle::kMarks, of.colour};
  for (const FrameMeasures& m : of.run->frames) {
    if (m.repartitioned) curve.points.push_back({1.0 * m.frame, measure(m)});
  }
  return curve;
}

Panel frame_panel(const char* title, const char* unit, const std::vector<Named>& runs,
                  const Measure& measure) {
  Panel panel{title, {"frame"}, {unit, 0, 0}, {}, PanelKind::kCurves};
  for (const Named& named : runs) panel.curves.push_back(over_frames(named, measure));
  for (const Named& named : runs) {
    if (named.run->run.balance == BalanceMode::kCombined) {
      panel.curves.push_back(repartition_marks(named, measure));
    }
  }
  return panel;
}

// Figures 5 to 7: the paper's four measures, and two of ours.
Plot sequence_plot(const std::string& name, const std::vector<Named>& runs, bool casting) {
  Plot plot{name, {}, 2};
  plot.panels = {frame_panel("(a) Refinement, mean over ranks", "weight", runs, refinement),
                 frame_panel("(b) Deviation of refinement over ranks", "weight", runs,
                             [](const FrameMeasures& m) { return m.deviation; }),
                 frame_panel("(c) Distance to the serial pattern", "share of samples", runs, distance),
                 frame_panel("(d) Samples", "samples in the frame", runs, samples),
                 frame_panel("Deviation / mean of refinement", "ratio", runs, relative_deviation),
                 casting ? frame_panel("Samples cast from the frame before", "samples in the frame", runs,
                                       [](const FrameMeasures& m) { return m.samples_cast; })
                         : frame_panel("Samples received from other ranks", "share of the frame's samples",
                                       runs, received_per_sample)};
  return plot;
}

Plot simple_plot(const Runs& runs, int ranks) {
  std::vector<Named> named;
  for (const BalanceMode mode : kModes) {
    const MeasuredRun& run = runs.find(kSimple, ranks, mode);
    named.push_back({std::string(to_word(mode)), &run, static_cast<int>(named.size())});
  }
  return sequence_plot(fmt::format("simple-{}", ranks), named, false);
}

Plot casting_plot(const Runs& runs) {
  std::vector<Named> named;
  for (const MeasuredRun* run : runs.all(kCasting)) {
    std::string name(to_word(run->run.balance));
    int colour = static_cast<int>(std::find(kModes.begin(), kModes.end(), run->run.balance) - kModes.begin());
    if (run->run.balance == BalanceMode::kCombined) {
      if (run->run.keep_samples) name += ", kept";
      if (run->run.keep_samples) colour = static_cast<int>(kModes.size());
    }
    named.push_back({name, run, colour});
  }
  return sequence_plot("casting", named, true);
}

constexpr Frames kStill = {5, 10};

Panel ranks_panel(const Runs& runs, const char* title, const char* unit, const Measure& measure) {
  Panel panel{title, {"ranks", 2}, {unit, 0, 0}, {}, PanelKind::kCurves};
  const std::vector<int> sides = runs.sides_of(kScaling);
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    Curve curve{std::string(to_word(kModes[i])), {}, CurveStyle::kMarkedLine, static_cast<int>(i)};
    for (const int ranks : runs.ranks_of(kScaling)) {
      const MeasuredRun& run = runs.find(kScaling, [&](const PaperRun& r) {
        return r.ranks == ranks && r.balance == kModes[i] && r.side == sides.front();
      });
      if (!run.frames.empty()) curve.points.push_back({1.0 * ranks, mean(run, kStill, measure)});
    }
    if (!curve.points.empty()) panel.curves.push_back(std::move(curve));
  }
  return panel;
}

Panel speedup_panel(const Runs& runs, const char* title, double Speedup::*value, bool ideal_is_ranks) {
  Panel panel{title, {"ranks", 2}, {"AchievementSpeedup"}, {}, PanelKind::kCurves};
  if (ideal_is_ranks) panel.y.log_base = 2;
  if (!ideal_is_ranks) panel.y.from = 0;
  Curve ideal{"ideal", {}, CurveStyle::kReference};
  for (const int ranks : runs.ranks_of(kScaling)) {
    ideal.points.push_back({1.0 * ranks, ideal_is_ranks ? 1.0 * ranks : 1.0});
  }
  const std::vector<Speedup> all = speedups(runs);
  for (const int side : runs.sides_of(kScaling)) {
    Curve curve{fmt::format("{0}x{0}", side), {}, CurveStyle::kMarkedLine};
    for (const Speedup& s : all) {
      if (s.side == side) curve.points.push_back({1.0 * s.ranks, s.*value});
    }
    panel.curves.push_back(std::move(curve));
  }
  panel.curves.push_back(std::move(ideal));
  return panel;
}

Plot scaling_plot(const Runs& runs) {
  Plot plot{"scaling", {}, 2};
  plot.panels = {ranks_panel(runs, "(a) Refinement, mean over ranks", "weight", refinement),
                 ranks_panel(runs, "(b) Deviation / mean of refinement", "ratio", relative_deviation),
                 ranks_panel(runs, "(c) Distance to the serial pattern", "share of samples", distance),
                 ranks_panel(runs, "(d) Samples", "samples in the frame", samples),
                 speedup_panel(runs, "Refine(1, f/p) / Refine(p, f)", &Speedup::turned, false),
                 speedup_panel(runs, "Refine(1, f) / Refine(p, f)", &Speedup::first, true)};
  return plot;
}

struct Part {
  const char* name;
  Measure measure;
};

Panel bars_panel(const Runs& runs, const char* title, const char* unit, const std::vector<Part>& parts) {
  Panel panel{title, {"ranks"}, {unit, 0, 0}, {}, PanelKind::kStackedBars};
  for (const Part& part : parts) {
    Curve curve{part.name, {}};
    for (const int ranks : runs.ranks_of(kCosts)) {
      curve.points.push_back(
          {1.0 * ranks, mean(runs.find(kCosts, ranks, BalanceMode::kCombined), {1, 10}, part.measure)});
    }
    panel.curves.push_back(std::move(curve));
  }
  return panel;
}

Panel growth_panel(const Runs& runs) {
  Panel panel{"(c) Casting on one rank", {"frame"}, {"samples in the frame", 0, 0}, {}, PanelKind::kCurves};
  for (const MeasuredRun* run : runs.all(kGrowth)) {
    const bool cast = run->run.cast != CastChoice::kOff;
    panel.curves.push_back(over_frames({cast ? "with cast" : "no cast", run, cast ? 1 : 0}, samples));
    if (cast) {
      panel.curves.push_back(
          over_frames({"samples cast", run, 2}, [](const FrameMeasures& m) { return m.samples_cast; }));
    }
  }
  return panel;
}

Plot costs_plot(const Runs& runs) {
  Plot plot{"costs", {}, 2};
  plot.panels = {
      bars_panel(runs, "(a) Time by stage, all ranks", "ms of work a frame",
                 {{"sampling", [](const FrameMeasures& m) { return m.cpu_ms.sampling; }},
                  {"casting", [](const FrameMeasures& m) { return m.cpu_ms.casting; }},
                  {"reconstruction", [](const FrameMeasures& m) { return m.cpu_ms.reconstruction; }},
                  {"balancing", [](const FrameMeasures& m) { return m.cpu_ms.balancing; }}}),
      bars_panel(runs, "(b) Bytes by kind, all ranks", "kB a frame",
                 {{"samples", [](const FrameMeasures& m) { return 1e-3 * m.bytes_samples; }},
                  {"pixels", [](const FrameMeasures& m) { return 1e-3 * m.bytes_pixels; }},
                  {"balancing", [](const FrameMeasures& m) { return 1e-3 * m.bytes_balance; }},
                  {"progress", [](const FrameMeasures& m) { return 1e-3 * m.bytes_progress; }}}),
      growth_panel(runs)};
  return plot;
}

Panel network_panel(const Runs& runs, std::string_view experiment, const char* title, const char* unit,
                    const std::function<double(const Machine&)>& value) {
  Panel panel{title, {unit, 10}, {"refinement / the best tried"}, {}, PanelKind::kCurves};
  Curve curve{"", {}, CurveStyle::kMarkedLine};
  double best = kNoValue;
  for (const MeasuredRun* run : runs.all(experiment)) {
    const double here = mean(*run, kStill, refinement);
    if (std::isnan(best)) best = here;
    if (value(run->run.machine) > 0) curve.points.push_back({value(run->run.machine), here / best});
  }
  panel.curves.push_back(std::move(curve));
  return panel;
}

Plot network_plot(const Runs& runs) {
  return {"network",
          {network_panel(runs, kLatency, "Latency", "microseconds",
                         [](const Machine& m) { return 1e6 * m.latency_s; }),
           network_panel(runs, kBandwidth, "Bandwidth of each rank", "MB/s",
                         [](const Machine& m) { return 1e-6 * m.bytes_per_second; })},
          2};
}

Table findings_table(const std::vector<Finding>& all) {
  Table table{{"finding", "holds", "measured", "criterion", "why not", "section"}, {}, {}};
  for (const Finding& f : all) {
    const char* verdict = !f.holds ? "not measured" : *f.holds ? "holds" : "does not hold";
    table.rows.push_back({f.claim, verdict, f.measured, f.criterion, f.why_not, f.source});
    table.tones.push_back(!f.holds ? Tone::kPlain : *f.holds ? Tone::kGood : Tone::kBad);
  }
  return table;
}

Table speedup_table(const Runs& runs) {
  Table table{
      {"side [pixels]", "ranks", "Refine(1, f/p) / Refine(p, f)", "Refine(1, f) / Refine(p, f)"}, {}, {}};
  for (const Speedup& s : speedups(runs)) {
    table.rows.push_back({std::int64_t{s.side}, std::int64_t{s.ranks}, s.turned, s.first});
  }
  std::stable_sort(table.rows.begin(), table.rows.end(), [](const auto& a, const auto& b) {
    return std::get<std::int64_t>(a[0]) < std::get<std::int64_t>(b[0]);
  });
  return table;
}

void add_gallery(const PaperResults& results, bool of_patterns, const char* heading, Page& page) {
  page.heading(heading);
  page.begin_gallery();
  for (const Picture& picture : results.pictures) {
    if (picture.of_pattern == of_patterns) page.picture(picture.png, picture.caption);
  }
  page.end_gallery();
}

std::string setting_text(const PaperResults& results, const PaperOptions& options) {
  const Machine machine = machine_of(options);
  const Calibration& calibration = results.calibration;
  return fmt::format(
      "All ranks are threads of one process under the work clock, which counts work instead of seconds: the "
      "results are the same on any computer. A frame's work, all ranks together, is found by calibration so "
      "that about {:.0f} samples fall on {} x {} pixels: {:.3g} units on {} ranks, {:.3g} on {}. Where the "
      "number of ranks varies (figures 8 and 9) all do the work of the former. The machine does {:.3g} units "
      "a "
      "second on each rank, its network takes {:.3g} microseconds and carries {:.4g} MB/s for each; on {} "
      "ranks "
      "a frame then lasts {:.3g} ms.",
      kPaperSamples, kPaperSide, kPaperSide, calibration.total_units, options.ranks.front(),
      calibration.total_units * calibration.share.at(options.ranks.back()), options.ranks.back(),
      machine.units_per_second, 1e6 * machine.latency_s, 1e-6 * machine.bytes_per_second,
      options.ranks.back(), 1e3 * calibration.frame_s);
}

}  // namespace

Table frames_table(const PaperResults& results) {
  Table table{{"experiment",
               "sequence",
               "ranks",
               "side [pixels]",
               "balance",
               "cast",
               "keep samples",
               "share of work",
               "latency [s]",
               "bandwidth [bytes/s]",
               "frame",
               "refinement",
               "deviation",
               "distance to serial",
               "density at borders",
               "samples",
               "samples cast",
               "samples received",
               "repartitioned",
               "late [ms]",
               "sampling [ms]",
               "casting [ms]",
               "reconstruction [ms]",
               "balancing [ms]",
               "idle [ms]",
               "sample bytes",
               "progress bytes",
               "balance bytes",
               "pixel bytes",
               "picture hash"},
              {},
              {}};
  for (const MeasuredRun& r : results.runs) {
    for (const FrameMeasures& m : r.frames) {
      table.rows.push_back({std::string(r.run.experiment),
                            std::string(r.run.sequence),
                            std::int64_t{r.run.ranks},
                            std::int64_t{r.run.side},
                            std::string(to_word(r.run.balance)),
                            r.run.cast == CastChoice::kOff ? "off" : "paper",
                            r.run.keep_samples ? "on" : "off",
                            r.run.share,
                            r.run.machine.latency_s,
                            r.run.machine.bytes_per_second,
                            std::int64_t{m.frame},
                            m.refinement,
                            m.deviation,
                            m.distance,
                            m.border_density,
                            m.samples,
                            m.samples_cast,
                            m.samples_received,
                            std::int64_t{m.repartitioned},
                            m.late_ms,
                            m.cpu_ms.sampling,
                            m.cpu_ms.casting,
                            m.cpu_ms.reconstruction,
                            m.cpu_ms.balancing,
                            m.cpu_ms.idle,
                            m.bytes_samples,
                            m.bytes_progress,
                            m.bytes_balance,
                            m.bytes_pixels,
                            m.picture_hash});
    }
  }
  return table;
}

void write_paper(const PaperResults& results, const PaperOptions& options, StudyOutput& output) {
  const Runs runs(results);
  const Table found = findings_table(findings(results));
  output.write_table("frames", frames_table(results));
  output.write_table("speedup", speedup_table(runs));
  output.write_table("findings", found);
  const Table errors = cast_errors_table(results.cast_errors);
  output.write_table("casting-errors", errors);
  Page& page = output.page();
  page.paragraph(
      "The experiments of Reisman, Gotsman and Schuster, Interactive-Rate Animation Generation by Parallel "
      "Progressive Ray-Tracing on Distributed-Memory Machines, J. Parallel Distrib. Comput. 60 (2000), "
      "section "
      "6, run anew.");
  page.paragraph(setting_text(results, options));
  if (options.quick) {
    page.note(
        "A quick trial: small pictures of a small tree on few ranks, and only the first frames. It shows "
        "that "
        "the study works; its findings are not the paper's.");
  }
  page.heading("Findings");
  page.table(found);
  int figure = 5;
  for (const int ranks : options.ranks) {
    page.heading(fmt::format("Balancing on {} ranks (the paper's figure {})", ranks, figure++));
    output.add_figure(simple_plot(runs, ranks),
                      "The simple sequence, without casting. Triangles: combined cut the image anew.");
  }
  page.heading("Casting (the paper's figure 7)");
  output.add_figure(casting_plot(runs), fmt::format("The casting sequence on {} ranks, samples cast as in "
                                                    "the paper. \"Kept\": where the image is cut anew "
                                                    "samples go to their new owners; the paper drops them.",
                                                    options.ranks.back()));
  page.heading("Ways of casting judged by true error");
  page.paragraph(cast_trial_text(cast_trial(options)));
  page.table(errors);
  page.heading("Number of ranks (the paper's figure 8)");
  output.add_figure(
      scaling_plot(runs),
      "Means over frames 5 to 10 of the simple sequence, the same work for all ranks together.");
  page.table(speedup_table(runs));
  page.heading("Costs (the paper's figure 9)");
  output.add_figure(costs_plot(runs), "The first ten frames of the casting sequence, combined balancing.");
  page.heading("Where communication begins to hurt");
  output.add_figure(network_plot(runs),
                    fmt::format("The simple sequence on {} ranks, combined balancing; 1 is the "
                                "best network tried.",
                                options.ranks.back()));
  add_gallery(results, true, "Sample patterns (the paper's figures 1 and 2)", page);
  add_gallery(results, false, "Frames, patterns and regions (the paper's figure 4)", page);
}

}  // namespace pprt
