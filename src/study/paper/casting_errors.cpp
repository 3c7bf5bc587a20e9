#include "study/paper/casting_errors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "parallel/settings/work_units.h"
#include "parser/anim/anim_parser.h"
#include "render/records/frame_summary.h"
#include "spd/spd.h"
#include "study/frame_series.h"
#include "study/reference.h"
#include "study/sequences.h"
#include "study/stopwatch.h"

namespace pprt {
namespace {

const std::map<std::string_view, const char*> kTurnScripts = {
    {"tree", kTreeTurn}, {"gears", kGearsTurn}, {"balls", kBallsTurn}, {"rings", kRingsTurn}};

// A sequence ready to be played.
struct Turn {
  const CastingTrial& trial;
  CompiledScene scene;
  std::vector<FrameRequest> frames;

  Turn(const TurnSequence& sequence, const CastingTrial& of_trial)
      : trial(of_trial), scene(compile(make_spd(sequence.scene))) {
    const Animation script = parse_animation(kTurnScripts.at(sequence.scene), "turn.anim").animation;
    frames = frames_of(scene, script, trial.judged.back(), View(), trial.side, sequence.speed);
  }

  void render(CastChoice cast, const std::vector<FrameRequest>& requests, double budget_units,
              const FrameSink& sink) const {
    SessionSettings settings{.sampler = SamplerChoice::kDelaunay};
    settings.width = settings.height = trial.side;
    settings.clock = ClockKind::kWork;
    settings.budget_units = static_cast<std::uint64_t>(budget_units);
    settings.frames_per_second = kWorkUnitsPerSecond / budget_units;
    settings.cast = cast;
    settings.learned_weights = trial.weights == WeightRule::kLearned;
    settings.seed = trial.seed;
    render_series(scene, requests, 1, settings, sink);
  }

  // Returns the work that makes so many samples in the second frame.
  double budget_for(double samples_per_pixel) const {
    const double pixels = static_cast<double>(trial.side) * trial.side;
    const WorkQuestion question{.samples = samples_per_pixel * pixels,
                                .guess_per_sample = 1600,
                                .pixel_units = pixels * static_cast<double>(price(Work::kPixel))};
    return work_for_samples(question, [&](double units) {
      double made = 0;
      render(CastChoice::kOff, {frames[0], frames[1]}, units,
             [&](const FinishedFrame& frame) { made = static_cast<double>(summarize(frame).samples); });
      return made;
    });
  }
};

// Returns the errors at each density of the trial.
std::vector<CastingErrors> judge(const TurnSequence& sequence, const CastingTrial& trial) {
  const Turn turn(sequence, trial);
  std::map<int, Image> references;
  for (const int number : trial.judged) {
    const Camera& camera = turn.frames[static_cast<std::size_t>(number - 1)].camera;
    references.emplace(number, supersampled({turn.scene, camera}, trial.reference_side));
  }
  std::vector<CastingErrors> all;
  for (const double density : trial.densities) {
    CastingErrors& errors = all.emplace_back(CastingErrors{sequence, density});
    const double budget_units = turn.budget_for(density);
    for (std::size_t i = 0; i < kWords<CastChoice>.size(); ++i) {
      turn.render(kWords<CastChoice>[i].value, turn.frames, budget_units, [&](const FinishedFrame& frame) {
        const auto reference = references.find(frame.order.number);
        if (reference == references.end()) return;
        errors.rmse[i] += rmse_of(frame.image, reference->second) / static_cast<double>(trial.judged.size());
      });
    }
  }
  return all;
}

}  // namespace

double CastingErrors::auto_ratio() const {
  static_assert(kWords<CastChoice>.back().value == CastChoice::kAuto);
  return rmse.back() / *std::min_element(rmse.begin(), rmse.end() - 1);
}

CastingTrial casting_trial(const PaperOptions& options) {
  CastingTrial trial;
  for (const char* scene : {"tree", "gears", "balls", "rings"}) {
    for (const double speed : {0.125, 1.0}) trial.sequences.push_back({scene, speed});
  }
  trial.densities = {0.3, 1.5};
  for (const int frame : {2, 5, 8, 12}) {
    if (frame <= options.frames) trial.judged.push_back(frame);
  }
  if (options.quick) trial.side = 64, trial.reference_side = 3;
  trial.weights = options.weights, trial.seed = options.seed;
  return trial;
}

std::vector<CastingErrors> run_casting_trial(const CastingTrial& trial,
                                             const std::function<void(const std::string&)>& report) {
  std::vector<std::vector<CastingErrors>> by_sequence(trial.sequences.size());
  std::mutex reporting;
  run_concurrently(by_sequence.size(), [&](std::size_t i) {
    const TurnSequence& sequence = trial.sequences[i];
    Stopwatch watch;
    by_sequence[i] = judge(sequence, trial);
    const std::lock_guard lock(reporting);
    report(fmt::format("casting errors: {}-turn at {:g} of its speed: {:.1f} s", sequence.scene,
                       sequence.speed, watch.lap()));
  });
  std::vector<CastingErrors> errors;
  for (const auto& some : by_sequence) errors.insert(errors.end(), some.begin(), some.end());
  return errors;
}

Table casting_errors_table(const std::vector<CastingErrors>& errors) {
  Columns<CastingErrors> columns = {{"scene", [](const CastingErrors& e) { return e.sequence.scene; }},
                                    {"speed", [](const CastingErrors& e) { return e.sequence.speed; }},
                                    {"samples a pixel", &CastingErrors::samples_per_pixel}};
  for (std::size_t i = 0; i < kWords<CastChoice>.size(); ++i) {
    columns.push_back({fmt::format("RMSE {}", kWords<CastChoice>[i].word),
                       [i](const CastingErrors& e) { return e.rmse[i]; }});
  }
  columns.push_back({"auto / best of the others", &CastingErrors::auto_ratio});
  return table_of(errors, columns);
}

std::string casting_trial_text(const CastingTrial& trial) {
  return fmt::format(
      "Root mean square errors on the display scale, means over frames {} of each sequence. The references "
      "are frames of {} samples per pixel. Pictures have {}x{} pixels and are made on one rank. At speed 1 "
      "the camera turns by 4 degrees and closes in by 1.5 % per frame. Without casting, a frame's work makes "
      "the samples per pixel given in the table.",
      fmt::join(trial.judged, ", "), trial.reference_side * trial.reference_side, trial.side, trial.side);
}

}  // namespace pprt
