#include "study/cast_errors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "parallel/clock/work_units.h"
#include "parallel/virtual_ranks.h"
#include "parser/anim_parser.h"
#include "pipeline/preparation/cast_choice.h"
#include "scene/animation.h"
#include "spd/spd.h"
#include "study/paper/runs.h"
#include "study/sequences.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

struct Turn {
  std::string_view scene;
  const char* script;
};

constexpr std::array kTurns = {Turn{"tree", kTreeTurn}, Turn{"gears", kGearsTurn}, Turn{"balls", kBallsTurn},
                               Turn{"rings", kRingsTurn}};

// One sequence to be run.
class Stage {
 public:
  Stage(const CastSequence& sequence, const CastTrial& trial)
      : sequence_(sequence),
        trial_(trial),
        scene_(compile(make_spd(sequence.scene))),
        turn_(parse_animation(script_of(sequence.scene), fmt::format("{}-turn.anim", sequence.scene))
                  .animation) {}

  const CompiledScene& scene() const { return scene_; }

  Camera camera(int frame) const {
    View base;
    base.width = base.height = trial_.side;
    return scene_.camera(view_at(turn_, 1 + (frame - 1) * sequence_.speed, base));
  }

  void run(CastChoice cast, int frames, double budget_units, const FrameSink& sink) const {
    SessionSettings settings;
    settings.width = settings.height = trial_.side;
    settings.clock = ClockKind::kWork;
    settings.budget_units = static_cast<std::uint64_t>(budget_units);
    settings.frames_per_second = kWorkUnitsPerSecond / budget_units;
    settings.cast = cast;
    settings.learned_weights = false;  // what is learned goes on with what is cast
    settings.seed = trial_.seed;
    Tracer tracer(scene_, Camera());
    run_virtual_ranks(
        1, settings, [&](int) { return probe_of(tracer); },
        [&](int index) -> std::optional<FrameRequest> {
          if (index == frames) return std::nullopt;
          return FrameRequest{index + 1, camera(index + 1)};
        },
        sink);
  }

  // The work that makes the wanted number of samples in the second frame, by one correction of a guess.
  double budget_for(double samples_per_pixel) const {
    constexpr double kGuessPerSample = 1600;  // units
    const double pixels = static_cast<double>(trial_.side) * trial_.side;
    const double wanted = samples_per_pixel * pixels;
    const double of_pixels = pixels * static_cast<double>(price(Work::kPixel));
    double made = 0;
    run(CastChoice::kOff, 2, of_pixels + wanted * kGuessPerSample,
        [&](const FinishedFrame& frame) { made = static_cast<double>(frame.ranks[0].samples_in_region); });
    return of_pixels + wanted * kGuessPerSample * wanted / made;
  }

 private:
  static const char* script_of(std::string_view scene) {
    return std::find_if(kTurns.begin(), kTurns.end(), [&](const Turn& t) { return t.scene == scene; })
        ->script;
  }

  const CastSequence& sequence_;
  const CastTrial& trial_;
  CompiledScene scene_;
  Animation turn_;
};

// The mean of n x n samples a pixel, each shown as a display would.
Image converged(const CompiledScene& scene, const Camera& camera, int n) {
  Tracer tracer(scene, camera);
  Image image(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Vec3d sum(0, 0, 0);
      for (int i = 0; i < n * n; ++i) {
        const int row = i / n, column = i % n;
        const Color c = tracer.trace(x + (column + 0.5) / n, y + (row + 0.5) / n).color;
        sum += Vec3d(std::clamp(c.x, 0.0f, 1.0f), std::clamp(c.y, 0.0f, 1.0f), std::clamp(c.z, 0.0f, 1.0f));
      }
      image.at(x, y) = Color(sum / (n * n));
    }
  }
  return image;
}

double display_rmse(const Image& image, const Image& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    sum += display_error(image.pixels[i], truth.pixels[i]);
  }
  return std::sqrt(sum / static_cast<double>(truth.pixels.size()));
}

// At each density of the trial.
std::vector<CastErrors> judge(const CastSequence& sequence, const CastTrial& trial) {
  const Stage stage(sequence, trial);
  std::map<int, Image> truth;
  for (const int frame : trial.judged) {
    truth.emplace(frame, converged(stage.scene(), stage.camera(frame), trial.reference_side));
  }
  std::vector<CastErrors> all;
  for (const double density : trial.densities) {
    CastErrors& errors = all.emplace_back(CastErrors{sequence, density});
    const double budget_units = stage.budget_for(density);
    for (std::size_t way = 0; way < kCastWays.size(); ++way) {
      stage.run(kCastWays[way], trial.judged.back(), budget_units, [&](const FinishedFrame& frame) {
        const auto reference = truth.find(frame.order.number);
        if (reference == truth.end()) return;
        errors.rmse[way] +=
            display_rmse(frame.image, reference->second) / static_cast<double>(trial.judged.size());
      });
    }
  }
  return all;
}

}  // namespace

double CastErrors::auto_ratio() const {
  static_assert(kCastWays.back() == CastChoice::kAuto);
  return rmse.back() / *std::min_element(rmse.begin(), rmse.end() - 1);
}

std::string_view to_word(CastChoice cast) {
  switch (cast) {
    case CastChoice::kOff:
      return "off";
    case CastChoice::kPaper:
      return "paper";
    case CastChoice::kVerified:
      return "verified";
    case CastChoice::kAuto:
      return "auto";
  }
  return "";
}

CastTrial cast_trial(const PaperOptions& options) {
  CastTrial trial;
  for (const Turn& turn : kTurns) {
    for (const double speed : {0.125, 1.0}) trial.sequences.push_back({turn.scene, speed});
  }
  trial.densities = {0.3, 1.5};
  for (const int frame : {2, 5, 8, 12}) {
    if (frame <= options.frames) trial.judged.push_back(frame);
  }
  if (options.quick) trial.side = 64, trial.reference_side = 3;
  trial.seed = options.seed;
  return trial;
}

std::vector<CastErrors> run_cast_trial(const CastTrial& trial,
                                       const std::function<void(const std::string&)>& tell) {
  std::vector<std::vector<CastErrors>> of_sequence(trial.sequences.size());
  std::atomic<std::size_t> next = 0;
  std::mutex telling;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < of_sequence.size(); i = next++) {
      const CastSequence& sequence = trial.sequences[i];
      const auto begin = std::chrono::steady_clock::now();
      try {
        of_sequence[i] = judge(sequence, trial);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        const std::lock_guard lock(telling);
        tell(fmt::format("casting errors: {}-turn at {:g} of its speed: {:.1f} s", sequence.scene,
                         sequence.speed, took.count()));
      } catch (...) {
        const std::lock_guard lock(telling);
        failure = std::current_exception();
        next = of_sequence.size();
      }
    }
  };
  {
    std::vector<std::jthread> workers(std::max(1u, std::thread::hardware_concurrency()));
    for (std::jthread& worker : workers) worker = std::jthread(work);
  }
  if (failure) std::rethrow_exception(failure);
  std::vector<CastErrors> errors;
  for (const auto& some : of_sequence) errors.insert(errors.end(), some.begin(), some.end());
  return errors;
}

Table cast_errors_table(const std::vector<CastErrors>& errors) {
  Table table{{"scene", "speed", "samples a pixel"}, {}, {}};
  for (const CastChoice way : kCastWays) table.columns.push_back(fmt::format("RMSE {}", to_word(way)));
  table.columns.push_back("auto / best of the others");
  for (const CastErrors& e : errors) {
    std::vector<Cell>& row = table.rows.emplace_back();
    row.emplace_back(std::string(e.sequence.scene));
    row.emplace_back(e.sequence.speed);
    row.emplace_back(e.samples_per_pixel);
    row.insert(row.end(), e.rmse.begin(), e.rmse.end());
    row.emplace_back(e.auto_ratio());
  }
  return table;
}

std::string cast_trial_text(const CastTrial& trial) {
  return fmt::format(
      "Root mean square errors on the display scale, means over frames {} of each sequence, against frames "
      "of {} samples a pixel; {}x{} pixels, one rank. At speed 1 the eye turns by 4 degrees a frame and "
      "closes in by 1.5 %. A frame's work is what makes so many samples a pixel when none is carried.",
      fmt::join(trial.judged, ", "), trial.reference_side * trial.reference_side, trial.side, trial.side);
}

}  // namespace pprt
