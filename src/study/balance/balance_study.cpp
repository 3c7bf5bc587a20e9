#include "study/balance/balance_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <limits>
#include <utility>

#include "base/diagnostics.h"
#include "cli/process/exit.h"
#include "cli/scenes/scene_source.h"
#include "image/contact_sheet.h"
#include "image/image_io.h"
#include "layers/pictures.h"
#include "parallel/balance/global_balance.h"
#include "parser/text_input.h"
#include "study/balance/figures.h"
#include "study/balance/results.h"
#include "study/report/output.h"
#include "study/word_list.h"

namespace pprt {
namespace {

std::vector<BalanceMode> policies_in(const std::string& list) {
  std::vector<std::string_view> known;
  for (const Word<BalanceMode>& entry : kWords<BalanceMode>) known.push_back(entry.word);
  std::vector<BalanceMode> policies;
  for (const std::string_view word : list.empty() ? known : words_in_list("--policy", list, known)) {
    const BalanceMode policy = find_word<BalanceMode>(word).value();
    if (std::find(policies.begin(), policies.end(), policy) == policies.end()) policies.push_back(policy);
  }
  return policies;
}

BalanceTraces read_traces(const std::string& path) {
  require_file(path);
  BalanceTraces traces =
      parse_balance_trace(read_text(path, std::numeric_limits<std::uint32_t>::max()), path);
  std::erase_if(traces.runs, [](const BalanceTrace& run) { return run.frames.empty(); });
  if (traces.runs.empty()) throw InputError(path + ":1: error: the trace holds no frame");
  return traces;
}

// A frame by its place in all rounds, with its run.
struct Place {
  std::size_t round;
  const TraceHeader* header;
  const TracedFrame* frame;
};

std::vector<Place> places_of(const std::vector<BalanceTrace>& runs) {
  std::vector<Place> places;
  for (const BalanceTrace& run : runs) {
    for (const TracedFrame& frame : run.frames) places.push_back({places.size(), &run.header, &frame});
  }
  return places;
}

std::vector<Place> drawn_places(const BalanceOptions& options, const std::vector<BalanceTrace>& runs) {
  const std::vector<Place> all = places_of(runs);
  std::vector<Place> drawn;
  if (options.frames.empty()) {
    for (const std::size_t i : {std::size_t{0}, all.size() / 2, all.size() - 1}) {
      if (drawn.empty() || drawn.back().round < i) drawn.push_back(all[i]);
    }
  }
  for (const int number : options.frames) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Place& place) { return place.frame->number == number; });
    if (found == all.end()) throw UsageError(fmt::format("--frames {}: the trace has no such frame", number));
    drawn.push_back(*found);
  }
  return drawn;
}

// Where a frame costs much: light is the most costly tile, each halving of the cost a step darker.
Image cost_map(const Place& place) {
  const TileGrid& grid = place.header->grid;
  const std::vector<double> costs = predicted_costs(grid, figures_under(*place.frame, place.frame->owners));
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

std::vector<Picture> region_maps(const std::vector<Place>& places, const std::vector<PolicyResult>& results) {
  constexpr int kWidth = 384;  // pixels
  std::vector<Picture> pictures;
  for (const PolicyResult& result : results) {
    for (const Place& place : places) {
      const Image map =
          region_picture(cost_map(place), place.header->grid, result.rounds[place.round].owners);
      pictures.push_back(
          {.caption = fmt::format("{}, frame {}", word_for(result.policy), place.frame->number),
           .png = encode_png(thumbnail(map, kWidth), {}, PictureKind::kDrawn),
           .file = fmt::format("regions-{}-{}.png", word_for(result.policy), place.frame->number)});
    }
  }
  return pictures;
}

Panel panel_over_rounds(const std::vector<PolicyResult>& results, const std::string& title,
                        const std::string& unit, double from, double (*value)(const ReplayedRound&)) {
  Panel panel{.title = title, .x = {.label = "frame"}, .y = {.label = unit, .log_base = 0, .from = from}};
  for (const PolicyResult& result : results) {
    panel.curves.push_back(
        curve_over(std::string(word_for(result.policy)), result.rounds, &ReplayedRound::frame, value));
  }
  return panel;
}

Plot plot_of(const std::vector<PolicyResult>& results) {
  return {"balance",
          {panel_over_rounds(results, "(a) Deviation of the loads", "% of the mean", 0,
                             [](const ReplayedRound& r) { return 100 * r.deviation; }),
           panel_over_rounds(results, "(b) Largest load", "of the mean", 1,
                             [](const ReplayedRound& r) { return r.worst; }),
           panel_over_rounds(results, "(c) Tiles moved", "tiles per frame", 0,
                             [](const ReplayedRound& r) { return static_cast<double>(r.moved); })}};
}

void write_page(const BalanceOptions& options, const std::string& command_line,
                const std::vector<BalanceTrace>& runs, const std::vector<Place>& drawn,
                const std::vector<PolicyResult>& results) {
  const TraceHeader& header = runs.front().header;
  StudyOutput output(options.directory, "Balancing replayed",
                     {{"command", command_line}, {"trace", options.file}, {"recorded by", header.version}});
  output.paragraph(
      fmt::format("{} on {} ranks, {}x{} pixels in tiles of {}, recorded under '{}'. A rank's load is the "
                  "time until its tiles have the mean weight of the whole image.",
                  header.scene, header.ranks, header.grid.width, header.grid.height, header.grid.tile_size,
                  word_for(header.settings.balance)));
  output.heading("Policies, mean over the frames");
  output.add_table("policies", policies_table(results));
  output.heading("Loads over the frames");
  output.add_figure(plot_of(results), "The policies, frame by frame.");
  output.write_table("rounds", rounds_table(results));
  output.heading("Who owns each tile");
  output.paragraph(
      "A hue is a rank. Light tiles are costly; six halvings of the cost lie between the most "
      "costly tile and the darkest.");
  output.add_gallery(region_maps(drawn, results));
  output.finish();
}

}  // namespace

std::vector<std::string> policy_words() {
  std::vector<std::string> words;
  for (const Word<BalanceMode>& entry : kWords<BalanceMode>) words.emplace_back(entry.word);
  return words;
}

void study_balance(const BalanceOptions& options, const std::string& command_line) {
  const std::vector<BalanceMode> policies = policies_in(options.policies);
  const BalanceTraces traces = read_traces(options.file);
  print_message(traces.warnings);
  const std::vector<Place> drawn = drawn_places(options, traces.runs);
  std::vector<PolicyResult> results;
  for (const BalanceMode policy : policies) results.push_back(replay_all(traces.runs, policy));
  const Table rounds = rounds_table(results), summary = policies_table(results);
  if (options.json) {
    print_output(json_lines(rounds, "round") + json_lines(summary, "policy"));
  } else {
    print_output(fmt::format("{}\nMean over the frames; tiles and repartitions in all:\n{}", aligned(rounds),
                             aligned(summary)));
  }
  if (!options.directory.empty()) write_page(options, command_line, traces.runs, drawn, results);
}

}  // namespace pprt
