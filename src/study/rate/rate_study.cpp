#include "study/rate/rate_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include "base/counted.h"
#include "cli/process/exit.h"
#include "study/frame_series.h"
#include "study/rate/held_rates.h"
#include "study/report/output.h"
#include "study/stopwatch.h"

namespace pprt {
namespace {

constexpr std::array kRates = {4.0, 6.0, 8.0, 12.0, 16.0, 20.0, 24.0, 30.0, 40.0, 60.0, 80.0, 120.0};
constexpr std::array kQuickRates = {8.0, 24.0, 60.0};
constexpr std::array kSamplers = {SamplerChoice::kAuto, SamplerChoice::kGrid};

std::vector<RateResult> measure_all(const HeldRun& run, bool is_quick) {
  const std::span<const double> rates = is_quick ? std::span<const double>(kQuickRates) : kRates;
  std::vector<RateResult> results(rates.size() * kSamplers.size());
  run_concurrently(results.size(), [&](std::size_t i) {
    results[i] = measure_held(kSamplers[i / rates.size()], rates[i % rates.size()], run);
  });
  return results;
}

std::vector<RateResult> of_sampler(const std::vector<RateResult>& results, SamplerChoice sampler) {
  std::vector<RateResult> chosen;
  std::copy_if(results.begin(), results.end(), std::back_inserter(chosen),
               [&](const RateResult& r) { return r.sampler == sampler; });
  return chosen;
}

const RateResult& best_of(const std::vector<RateResult>& results, double HeldErrors::*measure) {
  return *std::min_element(results.begin(), results.end(), [&](const RateResult& a, const RateResult& b) {
    return a.held.*measure < b.held.*measure;
  });
}

// Says of an end of the curve that the least error may lie beyond.
std::string_view if_extreme(const RateResult& best, const std::vector<RateResult>& own) {
  if (best.fps == own.front().fps) return ", the lowest tried";
  return best.fps == own.back().fps ? ", the highest tried" : "";
}

std::string best_rates(const std::vector<RateResult>& results, SamplerChoice sampler) {
  const std::vector<RateResult> own = of_sampler(results, sampler);
  const RateResult &by_rmse = best_of(own, &HeldErrors::rmse), &by_flip = best_of(own, &HeldErrors::flip);
  return fmt::format(
      "{}: the least RMSE over time, {:.4f}, is that of {:g} frames/s{}; the least FLIP, {:.4f}, that "
      "of {:g} frames/s{}",
      word_for(sampler), by_rmse.held.rmse, by_rmse.fps, if_extreme(by_rmse, own), by_flip.held.flip,
      by_flip.fps, if_extreme(by_flip, own));
}

Plot plot_of(const std::vector<RateResult>& results) {
  const auto panel_of = [&](const std::string& title, const std::string& label, double HeldErrors::*measure) {
    Panel panel{
        .title = title, .x = {.label = "frames per second", .log_base = 2}, .y = {.label = label, .from = 0}};
    for (const SamplerChoice sampler : kSamplers) {
      panel.curves.push_back(curve_over(
          std::string(word_for(sampler)), of_sampler(results, sampler), &RateResult::fps,
          [&](const RateResult& r) { return r.held.*measure; }, CurveStyle::kMarkedLine));
    }
    return panel;
  };
  return {"rate",
          {panel_of("(a) RMSE over time", "RMSE", &HeldErrors::rmse),
           panel_of("(b) FLIP over time", "FLIP", &HeldErrors::flip)}};
}

Table table_of_rates(const std::vector<RateResult>& results) {
  using R = RateResult;
  return table_of<R>(results, {{"sampler", &R::sampler},
                               {"frames/s", &R::fps},
                               {"rmse over time", [](const R& r) { return r.held.rmse; }},
                               {"flip over time", [](const R& r) { return r.held.flip; }},
                               {"samples a pixel", &R::samples}});
}

void write_page(const RateOptions& options, const HeldRun& run, const JudgedFilm& judged,
                const std::vector<RateResult>& results, const std::string& command_line) {
  StudyOutput output(options.directory, "Which frame rate shows a movement best",
                     {{"command", command_line},
                      {"pictures", fmt::format("{0} x {0} pixels", options.size)},
                      {"ranks", std::to_string(options.ranks)},
                      {"work units a second of a rank", fmt::format("{:.3g}", run.units_per_second)}});
  output.paragraph(fmt::format(
      "{}: {:g} s of it, judged at {:g} moments a second. At each moment a viewer sees the frame "
      "delivered last. It shows what was there when it was begun, a period before it was delivered. "
      "More frames a second are coarser, fewer are older. The idea of judging both as one error "
      "is from Woolley, Luebke, Watson and Dayal, Interruptible Rendering (2003).",
      run.moving.name, judged.seconds, judged.rate));
  output.paragraph(
      "Frames are made under the work clock. Its second is what a core of this machine does in a second, "
      "measured "
      "on the film's first frame; no deadline is missed there. FLIP is judged at every fourth moment.");
  for (const SamplerChoice sampler : kSamplers) output.note(best_rates(results, sampler));
  output.add_figure(plot_of(results), "Errors of what is seen, over time; 'grid' is uniform sampling.");
  output.add_table("rates", table_of_rates(results));
  output.finish();
}

RateOptions settled(RateOptions options) {
  if (options.size == 0) options.size = options.quick ? 64 : 192;
  if (options.seconds == 0) options.seconds = options.quick ? 0.25 : 1;
  if (options.reference_cells == 0) options.reference_cells = options.quick ? 2 : 3;
  return options;
}

// From the first moment at which a frame of each rate is seen, until the film ends. Throws UsageError where
// it ends before.
JudgedFilm judged_film(const MovingScene& moving, const RateOptions& options) {
  JudgedFilm judged{.begin_s = 1 / kRates.front(), .size = options.size, .cells = options.reference_cells};
  judged.seconds = std::min(options.seconds, moving.length_s - judged.begin_s);
  if (judged.seconds * judged.rate < 1)
    throw UsageError(fmt::format("{}: the film lasts {:.3g} s, but is judged from {:g} s on", moving.name,
                                 moving.length_s, judged.begin_s));
  return judged;
}

}  // namespace

void study_rate(const RateOptions& asked, const std::string& command_line) {
  const RateOptions options = settled(asked);
  const MovingScene moving = read_moving_scene(options.inputs);
  const JudgedFilm judged = judged_film(moving, options);
  Stopwatch watch;
  const double units = measured_units_per_second(subject_at(moving, 0, options.size), SamplerChoice::kAuto);
  const TrueFilm film = true_film_of(moving, judged);
  fmt::print(stderr, "pprt-study: {}: {}: {:.1f} s\n", moving.name,
             counted(film.pictures.size(), "true picture", "true pictures"), watch.lap());
  const HeldRun run{moving, film, options.ranks, units};
  const std::vector<RateResult> results = measure_all(run, options.quick);
  fmt::print(stderr, "pprt-study: {}: {}: {:.1f} s\n", moving.name, counted(results.size(), "run", "runs"),
             watch.lap());
  for (const SamplerChoice sampler : kSamplers) print_output(best_rates(results, sampler) + "\n");
  if (!options.directory.empty()) write_page(options, run, judged, results, command_line);
}

}  // namespace pprt
