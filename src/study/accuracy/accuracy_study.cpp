#include "study/accuracy/accuracy_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <iterator>
#include <sstream>
#include <utility>

#include "base/diagnostics.h"
#include "cli/scene_source.h"
#include "parser/anim_parser.h"
#include "scene/nff_writer.h"
#include "study/accuracy/page.h"
#include "study/accuracy/parts.h"
#include "study/output.h"

namespace pprt {
namespace {

constexpr int kSequenceCells = 4;  // of a sequence's converged frames: 32 samples a pixel
constexpr int kQuickSequenceCells = 2;
constexpr int kMostFrames = 8;             // of a script
constexpr int kMostFramesInRealTime = 40;  // where a rate is asked for
constexpr int kOrbitFrames = 24;           // then, without a script
constexpr int kFigureSize = 256;           // pixels

// What is played without a script: always, and where a rate is asked for.
constexpr const char* kRound = "Frames round the scene, with a jump after the third,";
constexpr const char* kOrbit = "Frames that go round the scene by 14.4 degrees a second,";

// What is done to one scene, told on standard error with the time that it took.
class Progress {
 public:
  explicit Progress(std::string scene) : scene_(std::move(scene)) {}
  void tell(const std::string& what) {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - std::exchange(since_, now);
    fmt::print(stderr, "pprt-study: {}: {}: {:.1f} s\n", scene_, what, passed.count());
  }

 private:
  std::string scene_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

// A scene read, and what is needed to measure it.
struct Stage {
  std::string name;
  SceneDescription description;
  std::string nff;  // canonical: stands for the scene
  CompiledScene scene;

  Camera camera(int size) const {
    View view = *description.view;
    view.width = view.height = size;
    return scene.camera(view);
  }
};

Stage make_stage(const std::string& name) {
  SceneDescription description = load_scene(name).scene;
  if (!description.view) throw InputError(fmt::format("{}: the scene has no view", name));
  std::ostringstream nff;
  write_nff(description, nff);
  CompiledScene scene = compile(description);
  return {name, std::move(description), nff.str(), std::move(scene)};
}

// All that is measured.
struct Results {
  std::vector<SceneCurves> curves, small_curves;  // those beside other renderers are smaller
  std::vector<ForeignResult> foreign;
  std::vector<SceneEffects> effects;
  std::vector<NamedPicture> pictures;
  std::vector<RatePoint> rates;
  std::vector<Punctuality> punctuality;
};

// Of the pictures of sequences. The planner's are as large as was asked for.
int sequence_size(const AccuracyOptions& options) {
  if (options.directory.empty()) return options.size;
  return options.quick ? options.size / 2 : options.size / 4;
}

// A sequence with what it is judged by, and the rates to try.
struct Sequence {
  std::vector<Shot> shots;
  std::vector<Image> references;
  RateSettings settings;
};

std::vector<Shot> shots_of(const Stage& stage, const Animation* script, const AccuracyOptions& options) {
  return sequence_of(stage.scene, *stage.description.view, script, sequence_size(options),
                     options.quick ? kMostFrames / 2 : kMostFrames);
}

// Those that are played where a rate is asked for.
std::vector<Shot> shots_at(double fps, const Stage& stage, const Animation* script,
                           const AccuracyOptions& options) {
  const View& view = *stage.description.view;
  const int shortened = options.quick ? 2 : 1, size = sequence_size(options);
  if (!script) return orbit_of(stage.scene, view, size, fps, kOrbitFrames / shortened);
  return sequence_of(stage.scene, view, script, size, kMostFramesInRealTime / shortened);
}

Sequence make_sequence(const Stage& stage, std::vector<Shot> shots, const AccuracyOptions& options) {
  Sequence sequence;
  sequence.shots = std::move(shots);
  for (const Shot& shot : sequence.shots) {
    sequence.references.push_back(cached_reference(stage.nff, {stage.scene, shot.camera},
                                                   options.quick ? kQuickSequenceCells : kSequenceCells,
                                                   cache_directory(options))
                                      .image);
  }
  RateSettings& settings = sequence.settings;
  settings.ranks = options.ranks;
  settings.seed = options.seed;
  settings.units_per_second = measured_units_per_second({stage.scene, sequence.shots.front().camera});
  if (options.quick) settings.rates = {60, 120, 240};
  return sequence;
}

std::vector<RatePoint> rates_of(const Stage& stage, const Sequence& s) {
  return measure_rates(stage.name, stage.scene, s.shots, s.references, s.settings);
}

// `without_script` names the frames that are played then.
std::string rates_setting(const AccuracyOptions& options, const Animation* script,
                          const std::string& without_script) {
  return fmt::format(
      "{} of {} x {} pixels on {} under the work clock, which counts work instead of seconds: a second is "
      "what a core of this machine does in a second, measured on each scene.",
      script ? "The frames of " + script->name : without_script, sequence_size(options),
      sequence_size(options), options.ranks == 1 ? "one rank" : fmt::format("{} ranks", options.ranks));
}

// Other programs, and this one at their size.
std::vector<ForeignResult> foreign_of(const Stage& stage, int size) {
  return {measure_povray(stage.name, stage.description, size),
          measure_tachyon(stage.name, stage.description, size)};
}

void measure_scene(const Stage& stage, const Animation* script, const AccuracyOptions& options,
                   Results& results) {
  Progress progress(stage.name);
  const std::filesystem::path cache = cache_directory(options);
  const Subject subject{stage.scene, stage.camera(options.size)};
  const Reference reference = cached_reference(stage.nff, subject, options.reference_cells, cache);
  progress.tell(fmt::format("converged frame, {} samples a pixel, its own rmse {:.5f}", reference.samples,
                            reference.own_rmse));
  const int small = options.size / 2;
  const Subject small_subject{stage.scene, stage.camera(small)};
  const Reference small_reference =
      cached_reference(stage.nff, small_subject, options.reference_cells, cache);
  // Other renderers go beside the curves, which CPU times allow.
  auto foreign = std::async(std::launch::async, [&] { return foreign_of(stage, small); });
  CurveSettings settings{options.repeats, CurveSettings().greatest_share, options.seed};
  results.curves.push_back(
      measure_curves(stage.name, subject, reference, accuracy_methods(), settings, thread_cpu_seconds));
  progress.tell(fmt::format("{} pictures", results.curves.back().points.size()));
  settings.repeats = 1;
  const std::vector<Method> methods = {progressive_method(), uniform_method()};
  results.small_curves.push_back(
      measure_curves(stage.name, small_subject, small_reference, methods, settings, thread_cpu_seconds));
  const std::vector<ForeignResult> others = foreign.get();
  results.foreign.insert(results.foreign.end(), others.begin(), others.end());
  progress.tell("other renderers");
  results.effects.push_back(measure_effects(stage.name, stage.description, subject.camera, reference.image,
                                            options.repeats, thread_cpu_seconds));
  progress.tell("effects");
  std::vector<NamedPicture> pictures = figure_pictures(
      stage.name, file_word(stage.name), {stage.scene, stage.camera(std::min(options.size, kFigureSize))},
      options.seed, thread_cpu_seconds);
  std::move(pictures.begin(), pictures.end(), std::back_inserter(results.pictures));
  const Sequence sequence = make_sequence(stage, shots_of(stage, script, options), options);
  const std::vector<RatePoint> rates = rates_of(stage, sequence);
  results.rates.insert(results.rates.end(), rates.begin(), rates.end());
  progress.tell("frame rates");
  const std::vector<Punctuality> punctuality =
      measure_punctuality(stage.name, stage.scene, sequence.shots, sequence.references, sequence.settings);
  results.punctuality.insert(results.punctuality.end(), punctuality.begin(), punctuality.end());
  progress.tell("deadlines");
}

Provenance facts_of(const AccuracyOptions& options, const std::string& command_line) {
  return {{"command", command_line},
          {"seed", std::to_string(options.seed)},
          {"pictures", fmt::format("{0} x {0} pixels", options.size)},
          {"time", "CPU time of one thread, median of the repeats"}};
}

struct Inputs {
  std::vector<std::string> scenes;
  std::optional<Animation> script;
};

Inputs read_inputs(const AccuracyOptions& options) {
  Inputs inputs;
  std::string script_path;
  for (const std::string& name : options.inputs) {
    if (!is_script_name(name)) {
      inputs.scenes.push_back(name);
      continue;
    }
    if (inputs.script) throw UsageError("there can be one animation script only");
    inputs.script = read_animation(name).animation;
    script_path = name;
  }
  if (inputs.scenes.empty()) {
    inputs.scenes = inputs.script && inputs.script->scene
                        ? std::vector{scene_of_script(*inputs.script, script_path)}
                        : std::vector<std::string>{"spd:tree", "spd:gears", "spd:balls", "spd:tetra"};
  }
  return inputs;
}

void tell(const Stage& stage, const std::string& setting) {
  fmt::print(stderr, "pprt-study: {}: {}\n", stage.name, setting);
}

// At which rate there is the error.
void answer_rate(double rmse, const Stage& stage, const Animation* script, const AccuracyOptions& options) {
  Sequence sequence = make_sequence(stage, shots_of(stage, script, options), options);
  sequence.settings.casts = {CastChoice::kAuto};
  tell(stage, rates_setting(options, script, kRound));
  fmt::print("{}\n", plan(stage.name, rates_of(stage, sequence), {rmse, {}}));
}

// Which error there is at the rate.
void answer_error(double fps, const Stage& stage, const Animation* script, const AccuracyOptions& options) {
  Sequence s = make_sequence(stage, shots_at(fps, stage, script, options), options);
  s.settings.rates = {fps};
  s.settings.casts = {CastChoice::kAuto};
  tell(stage, rates_setting(options, script, kOrbit));
  fmt::print("{}\n", plan(stage.name, rates_of(stage, s), {{}, fps}));
  const auto run = [&](CastChoice cast) {
    return measure_in_real_time(stage.name, stage.scene, s.shots, s.references, s.settings, cast, fps);
  };
  std::vector<Punctuality> with, without;
  std::vector<double> uniform;
  for (int turn = 0; turn < options.repeats; ++turn, ++s.settings.seed) {
    with.push_back(run(CastChoice::kAuto));
    without.push_back(run(CastChoice::kOff));
    uniform.push_back(uniform_rmse_in(options.ranks / fps, stage.scene, s.shots, s.references));
  }
  fmt::print("{}\n", plan_in_real_time(with, without, uniform));
}

void answer(const Inputs& inputs, const Animation* script, const AccuracyOptions& options) {
  for (const std::string& name : inputs.scenes) {
    const Stage stage = make_stage(name);
    if (options.want_rmse) answer_rate(*options.want_rmse, stage, script, options);
    if (options.want_fps) answer_error(*options.want_fps, stage, script, options);
  }
}

}  // namespace

AccuracyOptions settled(AccuracyOptions options) {
  constexpr int kSize = 512, kQuickSize = 96, kPlannedSize = 128, kCells = 8, kQuickCells = 4;
  if (options.size == 0) {
    options.size = options.quick ? kQuickSize : options.directory.empty() ? kPlannedSize : kSize;
  }
  if (options.reference_cells == 0) options.reference_cells = options.quick ? kQuickCells : kCells;
  return options;
}

std::filesystem::path cache_directory(const AccuracyOptions& options) {
  if (options.no_cache) return {};
  return options.cache.empty() ? default_cache_directory() : std::filesystem::path(options.cache);
}

void study_accuracy(const AccuracyOptions& asked, const std::string& command_line) {
  const AccuracyOptions options = settled(asked);
  const Inputs inputs = read_inputs(options);
  const Animation* script = inputs.script ? &*inputs.script : nullptr;
  const bool asked_something = options.want_rmse || options.want_fps;
  if (options.directory.empty() && !asked_something) throw UsageError("--output is required");
  if (asked_something) answer(inputs, script, options);
  if (options.directory.empty()) return;
  StudyOutput output(options.directory, "What accuracy costs in time", facts_of(options, command_line));
  Results results;
  for (const std::string& name : inputs.scenes) measure_scene(make_stage(name), script, options, results);
  write_curves(results.curves, output);
  write_figures(results.pictures, output);
  write_foreign(results.foreign, results.small_curves, options.size / 2, output);
  write_effects(results.effects, output);
  write_rates(results.rates, rates_setting(options, script, kRound), output);
  write_punctuality(results.punctuality, output);
  output.finish();
}

}  // namespace pprt
