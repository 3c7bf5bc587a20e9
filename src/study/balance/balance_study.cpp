#include "study/balance/balance_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <utility>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "base/printable.h"
#include "cli/process/exit.h"
#include "cli/scenes/scene_source.h"
#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "layers/pictures.h"
#include "parser/text/text_input.h"
#include "study/balance/figures.h"
#include "study/balance/results.h"
#include "study/report/output.h"

namespace pprt {
namespace {

// The runs of one file, of which there are several where a run was resumed.
struct Trace {
  std::string path;
  std::vector<BalanceTrace> runs;
  TraceResult result;

  const TraceHeader& header() const { return runs.front().header; }
};

Trace read_trace(const std::string& path) {
  require_file(path);
  BalanceTraces traces =
      parse_balance_trace(read_text(path, std::numeric_limits<std::uint32_t>::max()), path);
  print_message(traces.warnings);
  std::erase_if(traces.runs, [](const BalanceTrace& run) { return run.frames.empty(); });
  if (traces.runs.empty()) throw InputError(path + ":1: error: the trace holds no frame");
  Trace trace{.path = path, .runs = std::move(traces.runs), .result = {}};
  trace.result.name = printable(std::filesystem::path(path).stem().string());
  trace.result.balance = trace.header().settings.balance;
  for (const BalanceTrace& run : trace.runs) {
    std::vector<FrameFigures> figures = figures_of(run);
    std::move(figures.begin(), figures.end(), std::back_inserter(trace.result.frames));
  }
  return trace;
}

std::vector<Trace> read_traces(const std::vector<std::string>& paths) {
  std::vector<Trace> traces;
  for (const std::string& path : paths) {
    Trace trace = read_trace(path);
    for (const Trace& other : traces) {
      if (other.result.name == trace.result.name)
        throw UsageError(
            fmt::format("{} and {} have the same name; give each trace a name of its own", other.path, path));
    }
    traces.push_back(std::move(trace));
  }
  return traces;
}

// Returns what else than their balancing differs between the runs; empty: nothing.
std::string unlikeness(const Trace& a, const Trace& b) {
  if (a.header().scene != b.header().scene) return "scenes";
  if (a.header().ranks != b.header().ranks) return "numbers of ranks";
  if (!(a.header().grid == b.header().grid)) return "sizes";
  const auto same_frame = [](const FrameFigures& x, const FrameFigures& y) { return x.frame == y.frame; };
  const bool same = std::equal(a.result.frames.begin(), a.result.frames.end(), b.result.frames.begin(),
                               b.result.frames.end(), same_frame);
  return same ? "" : "frames";
}

// A frame in its run.
struct Place {
  const std::string* trace;  // its name
  const TileGrid* grid;
  const TracedFrame* frame;
  const FrameFigures* figures;
};

std::vector<Place> places_of(const Trace& trace) {
  std::vector<Place> places;
  for (const BalanceTrace& run : trace.runs) {
    for (const TracedFrame& frame : run.frames)
      places.push_back({&trace.result.name, &run.header.grid, &frame, &trace.result.frames[places.size()]});
  }
  return places;
}

// Returns the places to draw, per trace.
std::vector<std::vector<Place>> drawn_places(const std::vector<int>& asked,
                                             const std::vector<Trace>& traces) {
  const std::vector<FrameFigures>& frames = traces.front().result.frames;
  std::vector<int> numbers = asked;
  if (asked.empty()) numbers = {frames.front().frame, frames[frames.size() / 2].frame, frames.back().frame};
  std::vector<std::vector<Place>> drawn;
  for (const Trace& trace : traces) {
    const std::vector<Place> all = places_of(trace);
    std::vector<Place>& of_trace = drawn.emplace_back();
    for (const int number : numbers) {
      const auto found = std::find_if(all.begin(), all.end(),
                                      [&](const Place& place) { return place.frame->number == number; });
      if (found == all.end() && !asked.empty())
        throw UsageError(fmt::format("--frames {}: {} has no such frame", number, trace.path));
      const bool is_new = found != all.end() && (of_trace.empty() || of_trace.back().frame->number != number);
      if (is_new) of_trace.push_back(*found);
    }
  }
  return drawn;
}

// Shows where a frame costs much: light is the most costly tile, each halving of the cost a step darker.
Image cost_map(const Place& place) {
  const TileGrid& grid = *place.grid;
  const std::vector<double> costs = tile_costs(grid, *place.frame);
  const double most = *std::max_element(costs.begin(), costs.end());
  Image image(grid.width, grid.height);
  for (int tile = 0; tile < grid.tile_count(); ++tile) {
    constexpr double kSteps = 6;
    const double cost = std::max(costs[static_cast<std::size_t>(tile)], std::exp2(-kSteps) * most);
    const auto grey = most > 0 ? static_cast<float>(1 + std::log2(cost / most) / kSteps) : 0.5f;
    const PixelRect r = grid.pixels(tile);
    for (int y = r.y0; y < r.y1; ++y) {
      for (int x = r.x0; x < r.x1; ++x) image.at(x, y) = Color(grey, grey, grey);
    }
  }
  return image;
}

std::vector<Picture> region_maps(const std::vector<Place>& places) {
  constexpr int kWidth = 384;  // pixels
  std::vector<Picture> pictures;
  for (const Place& place : places) {
    const Image drawn = region_picture(cost_map(place), *place.grid, place.figures->owners);
    Image map = thumbnail(drawn, kWidth);
    label_ranks(map, *place.grid, place.figures->owners);
    pictures.push_back({.caption = fmt::format("{}, frame {}", *place.trace, place.frame->number),
                        .png = encode_png(map, {}, PictureKind::kDrawn),
                        .file = fmt::format("regions-{}-{}.png", *place.trace, place.frame->number)});
  }
  return pictures;
}

Panel panel_over_frames(const std::vector<TraceResult>& results, const std::string& title,
                        const std::string& unit, double from, double (*value)(const FrameFigures&)) {
  Panel panel{.title = title, .x = {.label = "frame"}, .y = {.label = unit, .log_base = 0, .from = from}};
  for (const TraceResult& result : results)
    panel.curves.push_back(curve_over(result.name, result.frames, &FrameFigures::frame, value));
  return panel;
}

Plot plot_of(const std::vector<TraceResult>& results) {
  return {"balance",
          {panel_over_frames(results, "(a) Deviation of the loads", "% of the mean", 0,
                             [](const FrameFigures& f) { return 100 * f.deviation; }),
           panel_over_frames(results, "(b) Largest load", "of the mean", 1,
                             [](const FrameFigures& f) { return f.worst; }),
           panel_over_frames(results, "(c) Tiles moved", "tiles per frame", 0,
                             [](const FrameFigures& f) { return static_cast<double>(f.moved); })}};
}

Provenance provenance_of(const std::vector<Trace>& traces, const std::string& command_line) {
  Provenance facts{{"command", command_line}};
  for (const Trace& trace : traces) facts.emplace_back(trace.path, "recorded by " + trace.header().version);
  return facts;
}

void write_page(const BalanceOptions& options, const std::string& command_line,
                const std::vector<Trace>& traces, const std::vector<TraceResult>& results,
                const std::vector<std::vector<Place>>& drawn) {
  StudyOutput output(options.directory, "Balancing of recorded runs", provenance_of(traces, command_line));
  for (const Trace& trace : traces) {
    const TraceHeader& header = trace.header();
    output.paragraph(fmt::format("{}: {} on {}, {}x{} pixels in tiles of {}, --balance {}.",
                                 trace.result.name, header.scene, counted(header.ranks, "rank", "ranks"),
                                 header.grid.width, header.grid.height, header.grid.tile_size,
                                 word_for(trace.result.balance)));
  }
  output.heading("Frame by frame");
  output.add_figure(plot_of(results), "The loads of the ranks, and the tiles that changed hands.");
  output.heading("Mean over the frames; tiles and repartitions in all");
  output.add_table("traces", traces_table(results));
  output.paragraph("A rank's load is the time until its tiles have the mean weight of the whole image.");
  output.write_table("frames", frames_table(results));
  output.heading("Who owned each tile");
  output.paragraph(
      "A hue is a rank, whose number stands in its region. Light tiles are costly; six halvings of the cost "
      "lie between the most "
      "costly tile and the darkest.");
  for (const std::vector<Place>& of_trace : drawn) output.add_gallery(region_maps(of_trace));
  output.finish();
}

}  // namespace

void study_balance(const BalanceOptions& options, const std::string& command_line) {
  const std::vector<Trace> traces = read_traces(options.files);
  const std::vector<std::vector<Place>> drawn = drawn_places(options.frames, traces);
  std::vector<TraceResult> results;
  for (const Trace& trace : traces) {
    results.push_back(trace.result);
    if (const std::string what = unlikeness(traces.front(), trace); !what.empty())
      print_message(fmt::format("warning: {} and {} are runs of different {}\n", traces.front().path,
                                trace.path, what));
  }
  const Table summary = traces_table(results);
  if (options.json) {
    print_output(json_lines(frames_table(results), "frame") + json_lines(summary, "trace"));
  } else {
    print_output(results.size() == 1 ? aligned(frames_table(results))
                                     : "Deviation of the loads:\n" + aligned(deviations_table(results)));
    print_output("\nMean over the frames; tiles and repartitions in all:\n" + aligned(summary));
  }
  if (!options.directory.empty()) write_page(options, command_line, traces, results, drawn);
}

}  // namespace pprt
