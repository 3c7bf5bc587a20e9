#include "study/accuracy/accuracy_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <future>
#include <iterator>
#include <sstream>
#include <utility>

#include "base/diagnostics.h"
#include "cli/scene_source.h"
#include "parser/anim_parser.h"
#include "scene/nff_writer.h"
#include "study/accuracy/page.h"
#include "study/accuracy/pictures.h"
#include "study/accuracy/planner.h"

namespace pprt {
namespace {

constexpr int kSequenceCells = 4, kQuickSequenceCells = 2;  // n of a sequence's converged frames
constexpr int kMostFrames = 8;                              // of a script
constexpr int kMostFramesInRealTime = 40;                   // of a script, for --want-fps
constexpr int kOrbitFrames = 24;                            // for --want-fps without a script
constexpr int kFigureSize = 256;                            // pixels
constexpr std::array kRates = {1.0, 2.0, 4.0, 8.0, 15.0, 24.0, 30.0, 60.0};
constexpr std::array kQuickRates = {60.0, 120.0, 240.0};
constexpr std::array kAllCasts = {CastChoice::kOff, CastChoice::kPaper, CastChoice::kVerified,
                                  CastChoice::kAuto};
constexpr std::array kAutoCast = {CastChoice::kAuto};

// Names of what is played without a script.
constexpr const char* kRound = "Frames round the scene, with a camera cut after the third,";
constexpr const char* kOrbit = "Frames that go round the scene by 14.4 degrees per second,";

// Reports the steps of one scene on standard error, with the time of each.
class StepTimer {
 public:
  explicit StepTimer(std::string scene) : scene_(std::move(scene)) {}
  void done(const std::string& step) {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - std::exchange(since_, now);
    fmt::print(stderr, "pprt-study: {}: {}: {:.1f} s\n", scene_, step, passed.count());
  }

 private:
  std::string scene_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

SceneDescription with_view(const std::string& name) {
  SceneDescription scene = load_scene(name).scene;
  if (!scene.view) throw InputError(fmt::format("{}: the scene has no view", name));
  return scene;
}

std::string canonical(const SceneDescription& scene) {
  std::ostringstream nff;
  write_nff(scene, nff);
  return nff.str();
}

// One scene under study, and everything that is measured on it.
class SceneStudy {
 public:
  // Throws InputError for a scene that cannot be read or has no view. `script` may be null.
  SceneStudy(const std::string& name, const Animation* script, const AccuracyOptions& options)
      : name_(name),
        options_(options),
        script_(script),
        description_(with_view(name)),
        nff_(canonical(description_)),
        scene_(compile(description_)) {}

  void measure(AccuracyResults& results) const;

  // Prints at which rate there is the error, or which error at the rate.
  void answer_rate(double rmse) const;
  void answer_error(double fps) const;

  // Describes the sequences; `without_script` names what is played then.
  std::string rates_setup(const char* without_script) const {
    return fmt::format(
        "{} of {} x {} pixels on {} under the work clock, which counts work instead of seconds: a second is "
        "what a core of this machine does in a second, measured on each scene.",
        script_ ? "The frames of " + script_->name : without_script, sequence_size(), sequence_size(),
        options_.ranks == 1 ? "one rank" : fmt::format("{} ranks", options_.ranks));
  }

 private:
  const View& view() const { return *description_.view; }

  // Side of a sequence's pictures, pixels: --size for the planner, otherwise a part of it.
  int sequence_size() const {
    return options_.directory.empty() ? options_.size : options_.size / (options_.quick ? 2 : 4);
  }

  Subject subject(int size) const {
    View square = view();
    square.width = square.height = size;
    return {scene_, scene_.camera(square)};
  }

  Reference reference(const Subject& subject, int cells) const {
    std::filesystem::path cache;
    if (!options_.no_cache)
      cache = options_.cache.empty() ? default_cache_directory().string() : options_.cache;
    return cached_reference(nff_, subject, cells, cache);
  }

  std::vector<FrameRequest> script_frames(int most) const {
    const int count = std::min(options_.quick ? most / 2 : most, script_->frames);
    return frames_of(scene_, *script_, count, view(), sequence_size());
  }

  std::vector<FrameRequest> frames() const {
    if (script_) return script_frames(kMostFrames);
    return round_with_cut(scene_, view(), sequence_size(), options_.quick ? kMostFrames / 2 : kMostFrames);
  }

  std::vector<FrameRequest> frames_at(double fps) const {
    if (script_) return script_frames(kMostFramesInRealTime);
    return orbit(scene_, view(), sequence_size(), fps, options_.quick ? kOrbitFrames / 2 : kOrbitFrames);
  }

  Sequence sequence_of(std::vector<FrameRequest> frames) const {
    Sequence sequence{name_, scene_, std::move(frames), {}, options_.ranks, 0, options_.seed};
    for (const FrameRequest& frame : sequence.frames) {
      sequence.references.push_back(
          reference({scene_, frame.camera}, options_.quick ? kQuickSequenceCells : kSequenceCells).image);
    }
    sequence.units_per_second = measured_units_per_second({scene_, sequence.frames.front().camera});
    return sequence;
  }

  std::span<const double> rates() const {
    return options_.quick ? std::span<const double>(kQuickRates) : std::span<const double>(kRates);
  }

  std::string name_;
  const AccuracyOptions& options_;
  const Animation* script_;
  SceneDescription description_;
  std::string nff_;  // canonical: stands for the scene
  CompiledScene scene_;
};

template <typename T>
void append(std::vector<T>& all, std::vector<T> more) {
  std::move(more.begin(), more.end(), std::back_inserter(all));
}

void SceneStudy::measure(AccuracyResults& results) const {
  StepTimer timer(name_);
  const Subject large = subject(options_.size), small = subject(options_.size / 2);
  const Reference converged = reference(large, options_.reference_cells);
  timer.done(fmt::format("converged frame, {} samples a pixel, its own rmse {:.5f}", converged.samples,
                         converged.own_rmse));
  const Reference small_converged = reference(small, options_.reference_cells);
  // Other renderers run beside the curves, which CPU times allow.
  auto renderers = std::async(std::launch::async, [&]() -> std::vector<RendererCurve> {
    return {measure_povray(name_, description_, options_.size / 2),
            measure_tachyon(name_, description_, options_.size / 2)};
  });
  CurveSettings settings{options_.repeats, CurveSettings().greatest_share, options_.seed};
  results.curves.push_back(measure_curves(name_, large, converged, accuracy_methods(), settings));
  timer.done(fmt::format("{} pictures", results.curves.back().points.size()));
  settings.repeats = 1;
  const std::vector<Method> methods = {progressive_method(), uniform_method()};
  results.small_curves.push_back(measure_curves(name_, small, small_converged, methods, settings));
  append(results.renderers, renderers.get());
  timer.done("other renderers");
  results.effects.push_back(
      measure_effects(name_, description_, large.camera, converged.image, options_.repeats));
  timer.done("effects");
  append(results.pictures,
         figure_pictures(name_, subject(std::min(options_.size, kFigureSize)), options_.seed));
  const Sequence sequence = sequence_of(frames());
  append(results.rates, measure_rates(sequence, rates(), kAllCasts));
  timer.done("frame rates");
  append(results.real_time, measure_in_real_time(sequence, rates()));
  timer.done("deadlines");
}

void SceneStudy::answer_rate(double rmse) const {
  const Sequence sequence = sequence_of(frames());
  fmt::print(stderr, "pprt-study: {}: {}\n", name_, rates_setup(kRound));
  fmt::print("{}\n", rate_with_error(measure_rates(sequence, rates(), kAutoCast), rmse));
}

void SceneStudy::answer_error(double fps) const {
  Sequence sequence = sequence_of(frames_at(fps));
  fmt::print(stderr, "pprt-study: {}: {}\n", name_, rates_setup(kOrbit));
  fmt::print("{}\n", error_at_rate(measure_rates(sequence, std::array{fps}, kAutoCast), fps));
  std::vector<RealTimeTurn> turns;
  for (int turn = 0; turn < options_.repeats; ++turn, ++sequence.seed) {
    const RealTimePoint with = measure_in_real_time(sequence, CastChoice::kAuto, fps);
    const RealTimePoint without = measure_in_real_time(sequence, CastChoice::kOff, fps);
    turns.push_back({with, without, uniform_rmse_in(options_.ranks / fps, sequence)});
  }
  fmt::print("{}\n", real_time_summary(turns));
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

// Fills in the defaults.
AccuracyOptions settled(AccuracyOptions options) {
  constexpr int kSize = 512, kQuickSize = 96, kPlannedSize = 128, kCells = 8, kQuickCells = 4;
  if (options.size == 0) {
    options.size = options.quick ? kQuickSize : options.directory.empty() ? kPlannedSize : kSize;
  }
  if (options.reference_cells == 0) options.reference_cells = options.quick ? kQuickCells : kCells;
  return options;
}

}  // namespace

void study_accuracy(const AccuracyOptions& asked, const std::string& command_line) {
  const AccuracyOptions options = settled(asked);
  const Inputs inputs = read_inputs(options);
  const Animation* script = inputs.script ? &*inputs.script : nullptr;
  const bool has_questions = options.want_rmse || options.want_fps;
  if (options.directory.empty() && !has_questions) throw UsageError("--output is required");
  for (const std::string& name : inputs.scenes) {
    if (!has_questions) break;
    const SceneStudy scene(name, script, options);
    if (options.want_rmse) scene.answer_rate(*options.want_rmse);
    if (options.want_fps) scene.answer_error(*options.want_fps);
  }
  if (options.directory.empty()) return;
  StudyOutput output(options.directory, "What accuracy costs in time", facts_of(options, command_line));
  AccuracyResults results;
  std::string setup;
  for (const std::string& name : inputs.scenes) {
    const SceneStudy scene(name, script, options);
    scene.measure(results);
    setup = scene.rates_setup(kRound);
  }
  write_accuracy(results, options.size / 2, setup, output);
  output.finish();
}

}  // namespace pprt
