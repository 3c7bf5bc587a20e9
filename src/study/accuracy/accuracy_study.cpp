#include "study/accuracy/accuracy_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <future>
#include <iterator>
#include <span>
#include <utility>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "cli/scenes/scene_source.h"
#include "parallel/exchange/samplers.h"
#include "parallel/settings/session_words.h"
#include "parser/anim/anim_parser.h"
#include "scene/animation/resting_nodes.h"
#include "scene/bytes/scene_bytes.h"
#include "study/accuracy/comparison.h"
#include "study/accuracy/crops.h"
#include "study/accuracy/page.h"
#include "study/accuracy/pictures.h"
#include "study/accuracy/planner.h"
#include "study/frame_series.h"
#include "study/rate/held_rates.h"
#include "study/stopwatch.h"

namespace pprt {
namespace {

// How much is measured: all, or what --quick leaves.
struct Effort {
  int size = 512;                  // of pictures, pixels square
  int cells = 8;                   // n of their converged frames
  int repeats = 3;                 // of each measurement
  int sequence_share = 4;          // pictures of a sequence are smaller by this factor
  int sequence_cells = 4;          // n of their converged frames
  int frames = 8;                  // of a sequence, at most
  int script_frames_planned = 40;  // of a script for --want-fps, at most
  int orbit_frames_planned = 24;   // for --want-fps without a script
  int judged_cells = 3;            // n of true pictures, for --want-fps
  double played_s = 2;             // in real time, at least
  std::vector<double> rates = {1, 2, 4, 8, 15, 24, 30, 60};  // frames per second
};
const Effort kFull;
const Effort kQuick = {.size = 96,
                       .cells = 4,
                       .repeats = 1,
                       .sequence_share = 2,
                       .sequence_cells = 2,
                       .frames = 4,
                       .script_frames_planned = 20,
                       .orbit_frames_planned = 12,
                       .judged_cells = 2,
                       .played_s = 1,
                       .rates = {60, 120, 240}};

// Returns the ways of casting that differ. Where only lights are carried there is one.
std::span<const CastChoice> casts_of(SamplerChoice sampler) {
  static constexpr std::array kOfSamples = {CastChoice::kOff, CastChoice::kPaper, CastChoice::kVerified,
                                            CastChoice::kAuto};
  static constexpr std::array kOfLights = {CastChoice::kOff, CastChoice::kAuto};
  return traits_of(sampler).cast_use == CastUse::kSamples ? std::span<const CastChoice>(kOfSamples)
                                                          : kOfLights;
}

constexpr int kPlannedSize = 128;  // of pictures where only the planner is asked, pixels square

const Effort& effort_of(const AccuracyOptions& options) {
  return options.quick ? kQuick : kFull;
}

struct Inputs {
  std::vector<std::string> scenes = {};
  std::optional<Animation> script = {};
  std::string script_path = {};
};

// One scene under study.
struct StudiedScene {
  std::string name;
  const AccuracyOptions& options;
  const Effort& effort;
  const Animation* script;  // null: none
  SceneDescription description;
  std::string hash;
  CompiledScene scene;

  // Side of a sequence's pictures, pixels: --size for the planner, otherwise a part of it.
  int sequence_size() const {
    return options.directory.empty() ? options.size : options.size / effort.sequence_share;
  }
  double start() const { return start_time(description.movement); }
  bool has_frames() const { return description.movement.times && description.movement.times->frames > 1; }
  Subject subject(int size) const {
    return {scene, square_camera(scene, *view_at(description, start()), size), start()};
  }
};

// Throws InputError for a scene that cannot be read or has no view.
StudiedScene studied_scene(const std::string& name, const Inputs& inputs, const AccuracyOptions& options) {
  const Animation* script = inputs.script ? &*inputs.script : nullptr;
  SceneDescription description =
      script ? read_scripted_scene(name, *script, inputs.script_path) : load_scene(name).scene;
  if (!description.view) throw InputError(fmt::format("{}: the scene has no view", name));
  std::string hash = hash_of(description);
  CompiledScene scene = compile(description);
  return {
      name, options, effort_of(options), script, std::move(description), std::move(hash), std::move(scene)};
}

Reference reference_of(const StudiedScene& studied, const Subject& subject, int cells) {
  const AccuracyOptions& options = studied.options;
  std::filesystem::path cache = options.cache;
  if (cache.empty()) cache = default_cache_directory();
  return cached_reference(studied.hash, subject, cells, options.no_cache ? std::filesystem::path() : cache);
}

constexpr double kDegreesPerSecond = 14.4;  // of an orbit, whatever the rate

MovingScene moving_scene_of(const StudiedScene& studied) {
  if (studied.script) return moved_by_script(studied.name, studied.description, *studied.script);
  if (studied.has_frames()) return moved_by_itself(studied.name, studied.description);
  return moved_round(studied.name, studied.description, kDegreesPerSecond);
}

// The first frames of the script, or others where there is none.
Sequence sequence_of(const StudiedScene& studied, int script_frames,
                     const std::vector<FrameRequest>& without_script) {
  const AccuracyOptions& options = studied.options;
  Sequence sequence{
      studied.name, studied.scene,          without_script, {}, options.ranks, options.sampler, 0,
      options.seed, studied.effort.played_s};
  if (studied.script || studied.has_frames()) {
    const int frames = studied.script ? studied.script->frames : studied.description.movement.times->frames;
    const MovingScene moving = moving_scene_of(studied);
    sequence.frames =
        frames_at(moving, moving.rate, std::min(script_frames, frames), studied.sequence_size());
  }
  for (const FrameRequest& frame : sequence.frames) {
    const Subject subject{studied.scene, frame.camera, frame.time};
    sequence.references.push_back(reference_of(studied, subject, studied.effort.sequence_cells).image);
  }
  sequence.units_per_second = measured_units_per_second(
      {studied.scene, sequence.frames.front().camera, sequence.frames.front().time}, options.sampler);
  return sequence;
}

// The script, or some frames round the scene with a camera cut.
Sequence short_sequence(const StudiedScene& studied) {
  constexpr int kFrames = 6, kCut = 3;
  constexpr double kDegreesPerFrame = 2;
  const int most = studied.effort.frames;
  return sequence_of(studied, most,
                     orbit(studied.scene, *studied.description.view, studied.sequence_size(),
                           std::min(most, kFrames), kDegreesPerFrame, kCut));
}

// The script, or an orbit.
Sequence sequence_at(double fps, const StudiedScene& studied) {
  return sequence_of(studied, studied.effort.script_frames_planned,
                     orbit(studied.scene, *studied.description.view, studied.sequence_size(),
                           studied.effort.orbit_frames_planned, kDegreesPerSecond / fps));
}

// Describes the sequences; `without_script` names what is played then.
std::string rates_setup(const StudiedScene& studied, const char* without_script) {
  const int ranks = studied.options.ranks;
  return fmt::format(
      "{0} of {1} x {1} pixels on {2}, by the sampler '{3}', under the work clock, which counts work instead "
      "of seconds: a second is what a core of this machine does in a second, measured on each scene.",
      studied.script         ? "The frames of " + studied.script->name
      : studied.has_frames() ? "The first frames of the scene's own animation,"
                             : without_script,
      studied.sequence_size(), ranks == 1 ? "one rank" : fmt::format("{} ranks", ranks),
      word_for(studied.options.sampler));
}

// Names of what is played without a script.
constexpr const char* kRound = "Frames round the scene, with a camera cut after the third,";
constexpr const char* kOrbit = "Frames that go round the scene by 14.4 degrees per second,";

template <typename T>
void append(std::vector<T>& all, std::vector<T> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

// Frames round the scene, so slowly that a viewer follows each edge.
SlowOrbit slow_orbit(const StudiedScene& studied) {
  constexpr int kFrames = 8;
  constexpr double kDegreesPerFrame = 0.25;
  SlowOrbit slow{studied.name, {}, {}};
  for (const FrameRequest& frame :
       orbit(studied.scene, *studied.description.view, studied.sequence_size(), kFrames, kDegreesPerFrame)) {
    slow.frames.push_back({studied.scene, frame.camera, studied.start()});
    slow.references.push_back(
        reference_of(studied, slow.frames.back(), studied.options.reference_cells).image);
  }
  return slow;
}

// Prints what a step of the study took.
class Steps {
 public:
  explicit Steps(const std::string& scene) : scene_(scene) {}
  void done(const std::string& step) {
    fmt::print(stderr, "pprt-study: {}: {}: {:.1f} s\n", scene_, step, watch_.lap());
  }

 private:
  const std::string& scene_;
  Stopwatch watch_;
};

std::vector<Method>::const_iterator find_method(const std::vector<Method>& methods, const std::string& name) {
  return std::find_if(methods.begin(), methods.end(), [&](const Method& m) { return m.name == name; });
}

// Measures the methods: curves, flicker and crops. Returns what the curves are judged by.
Reference measure_methods(const StudiedScene& studied, Steps& steps, AccuracyResults& results) {
  const AccuracyOptions& options = studied.options;
  const Subject subject = studied.subject(options.size);
  Reference converged = reference_of(studied, subject, options.reference_cells);
  steps.done(fmt::format("converged frame, {} a pixel, its own rmse {:.5f}",
                         counted(converged.samples, "sample", "samples"), converged.own_rmse));
  // Other renderers run beside the curves, which CPU times allow.
  auto renderers = std::async(std::launch::async, [&]() -> std::vector<RendererPoint> {
    if (options.only_curves) return {};
    return measure_other_renderers(studied.name, still_at(studied.description, studied.start()),
                                   options.size / 2);
  });
  const CurveRun run{results.methods, options.repeats, options.seed, options.busy_threads};
  results.curves.push_back(measure_curves(studied.name, subject, converged, run));
  steps.done(counted(results.curves.back().points.size(), "picture", "pictures"));
  append(results.renderers, renderers.get());
  append(results.flicker, measure_flicker(slow_orbit(studied), results.methods, options.seed));
  steps.done("flicker");
  const std::string leading = leading_method(results.curves.back());
  std::vector<Method> shown = {*find_method(results.methods, leading),
                               *find_method(results.methods, kUniform)};
  append(results.crops, crops_at_equal_time(studied.name, subject, converged.image, shown,
                                            results.curves.back().one_sample_s, options.seed));
  steps.done("crops");
  return converged;
}

void measure(const StudiedScene& studied, AccuracyResults& results) {
  constexpr int kFigureSize = 256;  // pixels
  const AccuracyOptions& options = studied.options;
  const std::string& name = studied.name;
  Steps steps(name);
  const Reference converged = measure_methods(studied, steps, results);
  if (options.only_curves) return;
  const Subject large = studied.subject(options.size), small = studied.subject(options.size / 2);
  const std::vector<Method> methods = {default_method(), uniform_method()};
  results.small_curves.push_back(measure_curves(name, small,
                                                reference_of(studied, small, options.reference_cells),
                                                {methods, 1, options.seed, options.busy_threads}));
  steps.done("curves at half the size");
  append(results.effects,
         measure_effects(name, studied.description, large.camera, converged.image, options.repeats));
  results.censuses.push_back(studied.scene.census());
  steps.done("effects");
  append(results.pictures,
         figure_pictures(name, studied.subject(std::min(options.size, kFigureSize)), options.seed));
  const Sequence sequence = short_sequence(studied);
  append(results.rates, measure_rates(sequence, studied.effort.rates, casts_of(sequence.sampler)));
  steps.done("frame rates");
  append(results.real_time, measure_in_real_time(sequence, studied.effort.rates));
  steps.done("deadlines");
}

// Prints at which rate a sequence has the error.
void print_rate(const StudiedScene& studied, double rmse) {
  const Sequence sequence = short_sequence(studied);
  fmt::print(stderr, "pprt-study: {}: {}\n", studied.name, rates_setup(studied, kRound));
  const auto points = measure_rates(sequence, studied.effort.rates, std::array{CastChoice::kAuto});
  fmt::print("{}\n", rate_with_error(points, rmse));
}

// Judges a quarter of a second, and a period of the lowest rate at least.
JudgedFilm short_judged_film(const StudiedScene& studied, double lowest_rate, double film_s) {
  constexpr double kSeconds = 0.25;
  constexpr int kPictures = 60;
  const double period_s = 1 / lowest_rate;
  const double span_s = std::max(1.0, std::round(kSeconds / period_s)) * period_s;
  JudgedFilm judged{.begin_s = period_s,
                    .rate = kPictures / span_s,
                    .size = studied.sequence_size(),
                    .cells = studied.effort.judged_cells};
  judged.seconds = std::min(span_s, film_s - judged.begin_s);
  return judged;
}

// Prints what a viewer sees of frames at the rate, and at half and twice the rate.
void print_seen(const StudiedScene& studied, double fps, double units_per_second) {
  const std::array rates = {fps, fps / 2, 2 * fps};
  const MovingScene moving = moving_scene_of(studied);
  const TrueFilm film = true_film_of(moving, short_judged_film(studied, fps / 2, moving.length_s));
  if (film.pictures.empty()) {
    fmt::print(stderr, "pprt-study: {}: the film is over before frames at {:g} frames/s are seen\n",
               studied.name, fps / 2);
    return;
  }
  const HeldRun run{moving, film, studied.options.ranks, units_per_second, studied.options.seed};
  std::vector<RateResult> results(rates.size());
  run_concurrently(results.size(),
                   [&](std::size_t i) { results[i] = measure_held(studied.options.sampler, rates[i], run); });
  fmt::print("{}\n", seen_at_rates(studied.name, results));
}

// Prints which error a sequence has at the rate.
void print_error(const StudiedScene& studied, double fps) {
  Sequence sequence = sequence_at(fps, studied);
  fmt::print(stderr, "pprt-study: {}: {}\n", studied.name, rates_setup(studied, kOrbit));
  const auto points = measure_rates(sequence, std::array{fps}, std::array{CastChoice::kAuto});
  fmt::print("{}\n", error_at_rate(points, fps));
  print_seen(studied, fps, sequence.units_per_second);
  std::vector<RealTimeTurn> turns;
  for (int turn = 0; turn < studied.options.repeats; ++turn, ++sequence.seed) {
    const RealTimePoint with = measure_in_real_time(sequence, CastChoice::kAuto, fps);
    const RealTimePoint without = measure_in_real_time(sequence, CastChoice::kOff, fps);
    turns.push_back({with, without, uniform_errors_in(sequence.ranks / fps, sequence)});
  }
  fmt::print("{}\n", real_time_summary(turns));
}

Inputs read_inputs(const AccuracyOptions& options) {
  Inputs inputs;
  for (const std::string& name : options.inputs) {
    if (!is_script_name(name)) {
      inputs.scenes.push_back(name);
      continue;
    }
    if (inputs.script) throw UsageError("there can be one animation script only");
    inputs.script = read_animation(name).animation;
    inputs.script_path = name;
  }
  if (!inputs.scenes.empty()) return inputs;
  inputs.scenes = {"spd:tree", "spd:gears", "spd:balls", "spd:tetra"};
  if (inputs.script && inputs.script->scene)
    inputs.scenes = {scene_of_script(*inputs.script, inputs.script_path)};
  return inputs;
}

// Tells what the machine did beside the measured thread.
std::string busy_fact(int threads) {
  return threads == 0
             ? "no threads beside the measured one (--busy 0)"
             : fmt::format("{0} threads rendered the same scene beside the measured one (--busy {0})",
                           threads);
}

// Fills in the defaults.
AccuracyOptions settled(AccuracyOptions options) {
  const Effort& effort = effort_of(options);
  const bool only_planned = options.directory.empty() && !options.quick;
  if (options.size == 0) options.size = only_planned ? kPlannedSize : effort.size;
  if (options.reference_cells == 0) options.reference_cells = effort.cells;
  if (options.repeats == 0) options.repeats = effort.repeats;
  return options;
}

}  // namespace

void study_accuracy(const AccuracyOptions& asked, const std::string& command_line) {
  const AccuracyOptions options = settled(asked);
  const Inputs inputs = read_inputs(options);
  const bool has_questions = options.want_rmse || options.want_fps;
  if (options.directory.empty() && !has_questions) throw UsageError("--output is required");
  const std::vector<Method> methods =
      options.methods.empty() ? accuracy_methods() : methods_of(options.methods);
  for (const std::string& name : inputs.scenes) {
    if (!has_questions) break;
    const StudiedScene scene = studied_scene(name, inputs, options);
    if (options.want_rmse) print_rate(scene, *options.want_rmse);
    if (options.want_fps) print_error(scene, *options.want_fps);
  }
  if (options.directory.empty()) return;
  StudyOutput output(options.directory, "What accuracy costs in time",
                     {{"command", command_line},
                      {"seed", std::to_string(options.seed)},
                      {"pictures", fmt::format("{0} x {0} pixels", options.size)},
                      {"time", "CPU time of one thread, median of the repeats"},
                      {"busy", busy_fact(options.busy_threads)}});
  AccuracyResults results;
  results.methods = methods;
  for (const std::string& name : inputs.scenes) {
    const StudiedScene scene = studied_scene(name, inputs, options);
    measure(scene, results);
    results.rates_setup = rates_setup(scene, kRound);
  }
  if (options.quick)
    output.note(
        "A quick trial (--quick): small pictures and few repeats. It shows that the study works; its figures "
        "say little.");
  write_accuracy(results, options.size / 2, output);
  output.finish();
}

}  // namespace pprt
