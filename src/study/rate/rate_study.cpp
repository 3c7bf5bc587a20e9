#include "study/rate/rate_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "base/diagnostics.h"
#include "cli/process/exit.h"
#include "cli/scenes/scene_source.h"
#include "image/metrics.h"
#include "parser/anim/anim_parser.h"
#include "study/accuracy/rates.h"
#include "study/frame_series.h"
#include "study/rate/held_frames.h"
#include "study/reference.h"
#include "study/report/output.h"
#include "study/stopwatch.h"

namespace pprt {
namespace {

constexpr std::array kRates = {4.0, 6.0, 8.0, 12.0, 16.0, 20.0, 24.0, 30.0, 40.0, 60.0, 80.0, 120.0};
constexpr std::array kQuickRates = {8.0, 24.0, 60.0};
constexpr std::array kSamplers = {SamplerChoice::kAuto, SamplerChoice::kGrid};
constexpr double kTrueRate = 240;  // pictures a second

// A film at any moment, in seconds since its beginning.
struct MovingScene {
  struct Moment {
    View view;
    double time = 0;  // of what moves in the scene
  };

  std::string name;
  CompiledScene scene;
  std::function<Moment(double moment_s)> at;
  std::function<bool(double from_s, double to_s)> cuts_between = [](double, double) { return false; };
};

MovingScene with_script(const std::string& script_path, const std::string& scene_name) {
  constexpr double kUsualRate = 24;  // of a script without one
  const Animation script = read_animation(script_path).animation;
  const SceneDescription description =
      (scene_name.empty() ? load_scene_of_script(script, script_path) : load_scene(scene_name)).scene;
  const std::optional<View> base = view_at(description, 0);
  if (!base) throw InputError(script_path + ": error: the scene has no view");
  const double rate = script.fps > 0 ? script.fps : kUsualRate;
  const auto frame_at = [rate, last = script.frames](double moment_s) {
    return std::min<double>(last, 1 + moment_s * rate);
  };
  MovingScene moving{.name = script_path, .scene = compile(description), .at = {}};
  moving.at = [script, frame_at, base = *base](double moment_s) {
    return MovingScene::Moment{view_at(script, frame_at(moment_s), base), moment_s};
  };
  moving.cuts_between = [script, frame_at](double from_s, double to_s) {
    return std::any_of(script.keys.begin(), script.keys.end(), [&](const CameraKey& key) {
      return key.cut && key.frame > frame_at(from_s) && key.frame <= frame_at(to_s);
    });
  };
  return moving;
}

// A scene that moves by itself.
MovingScene without_script(const std::string& scene_name) {
  const SceneDescription description = load_scene(scene_name).scene;
  if (!description.movement.times || description.movement.times->frames < 2)
    throw UsageError(scene_name + ": nothing moves without a script");
  const double start = description.movement.times->start, end = description.movement.times->end;
  MovingScene moving{.name = scene_name, .scene = compile(description), .at = {}};
  moving.at = [description, start, end](double moment_s) {
    const double time = std::min(end, start + moment_s);
    const std::optional<View> view = view_at(description, time);
    if (!view) throw InputError("error: the scene has no view");
    return MovingScene::Moment{*view, time};
  };
  return moving;
}

MovingScene moving_scene(const std::vector<std::string>& inputs) {
  std::string scene, script;
  for (const std::string& name : inputs) {
    std::string& place = is_script_name(name) ? script : scene;
    if (!place.empty()) throw UsageError("there can be one scene and one animation script");
    place = name;
  }
  return script.empty() ? without_script(scene) : with_script(script, scene);
}

// --- Measuring

// The film at one rate by one sampler.
struct RateResult {
  SamplerChoice sampler = SamplerChoice::kAuto;
  double fps = 1;
  HeldErrors held = {};
  double samples = 0;  // per pixel and frame
};

struct RateSetup {
  const MovingScene& moving;
  const RateOptions& options;
  const TrueFilm& film;
  double units_per_second = 1e9;  // of each rank
};

Subject subject_at(const MovingScene& moving, double moment_s, int size) {
  const MovingScene::Moment now = moving.at(moment_s);
  return {moving.scene, square_camera(moving.scene, now.view, size), now.time};
}

TrueFilm film_of(const MovingScene& moving, const RateOptions& options) {
  const double begin_s = 1 / kRates.front();
  std::vector<Image> pictures;
  for (int i = 0; i < options.seconds * kTrueRate; ++i) {
    const Subject subject = subject_at(moving, begin_s + i / kTrueRate, options.size);
    pictures.push_back(converged_reference(subject, options.reference_cells).image);
  }
  return true_film(kTrueRate, begin_s, std::move(pictures));
}

// Frame k is begun at k / fps and delivered a period later.
std::vector<FrameRequest> frames_at(double fps, const RateSetup& setup) {
  const double last_s = setup.film.moment(setup.film.pictures.size() - 1);
  std::vector<FrameRequest> frames;
  double before_s = 0;
  for (int k = 0; k <= frame_seen_at(last_s, fps, 1 / fps); ++k) {
    const double moment_s = k / fps;
    const Subject subject = subject_at(setup.moving, moment_s, setup.options.size);
    FrameRequest frame{.number = k + 1, .camera = subject.camera, .time = subject.time};
    frame.cut = k > 0 && setup.moving.cuts_between(before_s, moment_s);
    frame.moves = k > 0 && setup.moving.scene.moves_between(frames.back().time, frame.time);
    frames.push_back(frame);
    before_s = moment_s;
  }
  return frames;
}

RateResult measure(SamplerChoice sampler, double fps, const RateSetup& setup) {
  SessionSettings settings{.sampler = sampler};
  settings.width = settings.height = setup.options.size;
  settings.clock = ClockKind::kWork;
  settings.machine = cluster_machine();
  settings.machine.units_per_second = setup.units_per_second;
  settings.frames_per_second = fps;
  settings.budget_units = static_cast<std::uint64_t>(setup.units_per_second / fps);
  const std::vector<FrameRequest> frames = frames_at(fps, setup);
  std::vector<Image> pictures;
  double samples = 0;
  render_series(setup.moving.scene, frames, setup.options.ranks, settings, [&](FinishedFrame&& frame) {
    for (const RankReport& rank : frame.ranks) samples += static_cast<double>(rank.samples_in_region);
    pictures.push_back(clamped_to_display(frame.image));
  });
  const double pixels = static_cast<double>(setup.options.size) * setup.options.size;
  return {.sampler = sampler,
          .fps = fps,
          .held = errors_of({fps, 1 / fps, pictures}, setup.film),
          .samples = samples / (pixels * static_cast<double>(pictures.size()))};
}

std::vector<RateResult> measure_all(const RateSetup& setup) {
  const std::span<const double> rates = setup.options.quick ? std::span<const double>(kQuickRates) : kRates;
  std::vector<RateResult> results(rates.size() * kSamplers.size());
  run_concurrently(results.size(), [&](std::size_t i) {
    results[i] = measure(kSamplers[i / rates.size()], rates[i % rates.size()], setup);
  });
  return results;
}

// --- Telling

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

std::string best_rates(const std::vector<RateResult>& results, SamplerChoice sampler) {
  const std::vector<RateResult> own = of_sampler(results, sampler);
  const RateResult &by_rmse = best_of(own, &HeldErrors::rmse), &by_flip = best_of(own, &HeldErrors::flip);
  return fmt::format(
      "{}: the least RMSE over time, {:.4f}, is that of {:g} frames/s; the least FLIP, {:.4f}, that "
      "of {:g} frames/s",
      word_for(sampler), by_rmse.held.rmse, by_rmse.fps, by_flip.held.flip, by_flip.fps);
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

void write_page(const RateSetup& setup, const std::vector<RateResult>& results,
                const std::string& command_line) {
  const RateOptions& options = setup.options;
  StudyOutput output(options.directory, "Which frame rate shows a movement best",
                     {{"command", command_line},
                      {"pictures", fmt::format("{0} x {0} pixels", options.size)},
                      {"ranks", std::to_string(options.ranks)},
                      {"work units a second of a rank", fmt::format("{:.3g}", setup.units_per_second)}});
  output.paragraph(
      fmt::format("{}: {:g} s of it, judged at {:g} moments a second. At each moment a viewer sees the frame "
                  "delivered last. It "
                  "shows what was there when it was begun, a period before it was delivered. More frames a "
                  "second are coarser, "
                  "fewer are older. The idea of judging both as one error is from Woolley, Luebke, Watson "
                  "and Dayal, Interruptible "
                  "Rendering (2003).",
                  setup.moving.name, options.seconds, kTrueRate));
  output.paragraph(
      "Frames are made under the work clock. Its second is what a core of this machine does in a second, "
      "measured on "
      "the film's first frame; no deadline is missed there. FLIP is judged at every fourth moment.");
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

}  // namespace

void study_rate(const RateOptions& asked, const std::string& command_line) {
  const RateOptions options = settled(asked);
  const MovingScene moving = moving_scene(options.inputs);
  Stopwatch watch;
  const double units = measured_units_per_second(subject_at(moving, 0, options.size), SamplerChoice::kAuto);
  const TrueFilm film = film_of(moving, options);
  fmt::print(stderr, "pprt-study: {}: {} true pictures: {:.1f} s\n", moving.name, film.pictures.size(),
             watch.lap());
  const RateSetup setup{moving, options, film, units};
  const std::vector<RateResult> results = measure_all(setup);
  fmt::print(stderr, "pprt-study: {}: {} runs: {:.1f} s\n", moving.name, results.size(), watch.lap());
  for (const SamplerChoice sampler : kSamplers) print_output(best_rates(results, sampler) + "\n");
  if (!options.directory.empty()) write_page(setup, results, command_line);
}

}  // namespace pprt
