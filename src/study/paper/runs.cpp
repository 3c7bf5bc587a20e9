#include "study/paper/runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "base/content_hash.h"
#include "base/diagnostics.h"
#include "parallel/balance/partition.h"
#include "parallel/serial_pattern.h"
#include "parallel/virtual_ranks.h"
#include "parser/anim_parser.h"
#include "render/ledger.h"
#include "scene/animation.h"
#include "spd/spd.h"
#include "study/paper/pictures.h"
#include "study/sequences.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

constexpr double kNearBorder = 3;  // pixels: within this a sample counts as near a border of regions
constexpr int kQuickSide = 96;     // pixels
constexpr int kQuickTree = 5;
constexpr int kPatternRanks = 9;  // as in the paper's figure 2
constexpr int kStillFrames = 10;  // the simple sequence's first part

// What all runs have in common.
struct Setting {
  const PaperOptions& options;
  const CompiledScene& scene;
  Animation simple, casting;
  double total_units = 0;
};

double pixels_of(int side) {
  return static_cast<double>(side) * side;
}

// The work of all ranks grows with the picture, so that there are as many samples a pixel.
double budget(double total_units, const PaperRun& run) {
  return run.share * total_units * pixels_of(run.side) / pixels_of(kPaperSide) / run.ranks;
}

SessionSettings settings_of(const Setting& setting, const PaperRun& run) {
  SessionSettings s;
  s.width = s.height = run.side;
  s.clock = ClockKind::kWork;
  s.budget_units = static_cast<std::uint64_t>(budget(setting.total_units, run));
  s.frames_per_second = run.machine.units_per_second / static_cast<double>(s.budget_units);
  s.balance = run.balance;
  s.cast = run.cast;
  s.keep_samples = run.keep_samples;
  s.learned_weights = false;  // each rank would learn something else
  s.seed = setting.options.seed;
  s.report_samples = run.compare_serial;
  s.machine = run.machine;
  return s;
}

CameraSource cameras_of(const Setting& setting, const PaperRun& run) {
  const Animation& animation = run.sequence == kSimple ? setting.simple : setting.casting;
  View base;
  base.width = base.height = run.side;
  return [&animation, &setting, base, frames = run.frames](int index) -> std::optional<FrameRequest> {
    const int number = index + 1;
    if (number > frames) return std::nullopt;
    return FrameRequest{number, setting.scene.camera(view_at(animation, number, base)),
                        cut_before(animation, number)};
  };
}

// The ledger's figures of a frame.
FrameMeasures measures_of(const FinishedFrame& frame) {
  const Json record = frame_record(summarize(frame));
  const Json& cpu = record["cpu_ms"];
  const Json& bytes = record["bytes"];
  FrameMeasures m;
  m.frame = record["frame"];
  m.refinement = record["refinement"];
  m.deviation = record["refinement_dev"];
  m.samples = record["samples"];
  m.samples_cast = record["samples_cast"];
  m.samples_received = record["samples_received"];
  m.repartitioned = record["global_balance"];
  m.late_ms = record["late_ms"];
  m.cpu_ms = {cpu["sampling"], cpu["casting"], cpu["reconstruction"], cpu["balancing"], cpu["idle"]};
  m.bytes_samples = bytes["samples"];
  m.bytes_progress = bytes["progress"];
  m.bytes_balance = bytes["balance"];
  m.bytes_pixels = bytes["pixels"];
  const auto* bits = reinterpret_cast<const char*>(frame.image.pixels.data());
  m.picture_hash = content_hash(std::string(bits, frame.image.pixels.size() * sizeof(Color)));
  return m;
}

void compare_with_serial(const FinishedFrame& frame, const SessionSettings& settings, int ranks,
                         const Probe& probe, FrameMeasures& measures) {
  const std::vector<Sample> serial =
      serial_samples(settings, frame.order.camera, frame.samples.size(), probe);
  measures.distance = bucket_distance(frame.samples, serial);
  const TileGrid grid = tile_grid_for(settings.width, settings.height, ranks);
  const auto near = [&](const std::vector<Sample>& samples) {
    return static_cast<double>(samples_near_borders(samples, grid, frame.owners, kNearBorder));
  };
  if (const double expected = near(serial); expected > 0)
    measures.border_density = near(frame.samples) / expected;
}

MeasuredRun carry_out(const Setting& setting, const PaperRun& run,
                      const std::function<void(const FinishedFrame&)>& watch = {}) {
  const SessionSettings settings = settings_of(setting, run);
  std::vector<Tracer> tracers(static_cast<std::size_t>(run.ranks), Tracer(setting.scene, Camera()));
  Tracer serial_tracer(setting.scene, Camera());
  MeasuredRun measured{run, {}};
  run_virtual_ranks(
      run.ranks, settings, [&](int rank) { return probe_of(tracers[static_cast<std::size_t>(rank)]); },
      cameras_of(setting, run),
      [&](FinishedFrame&& frame) {
        FrameMeasures measures = measures_of(frame);
        if (run.compare_serial) {
          compare_with_serial(frame, settings, run.ranks, probe_of(serial_tracer), measures);
        }
        measured.frames.push_back(std::move(measures));
        if (watch) watch(frame);
      });
  return measured;
}

// The work that makes the paper's number of samples on so many ranks: costs per sample change little with
// their number, so that correcting a guess twice is enough.
double calibrated_units(Setting setting, int ranks, int side) {
  constexpr double kGuessPerSample = 1400;  // units
  const double pixel_units = pixels_of(kPaperSide) * static_cast<double>(price(Work::kPixel));
  PaperRun run;
  run.experiment = "calibration", run.ranks = ranks, run.side = side, run.frames = 5;
  run.compare_serial = false, run.machine = machine_of(setting.options);
  setting.total_units = pixel_units + kPaperSamples * kGuessPerSample;
  for (int i = 0; i < 2; ++i) {
    const MeasuredRun measured = carry_out(setting, run);
    const double wanted = kPaperSamples * pixels_of(side) / pixels_of(kPaperSide);
    const double made = 0.5 * (measured.frames[3].samples + measured.frames[4].samples);
    setting.total_units = pixel_units + (setting.total_units - pixel_units) * wanted / made;
  }
  return setting.total_units;
}

Calibration calibrate(const Setting& setting) {
  const PaperOptions& options = setting.options;
  const int side = picture_side(options);
  std::vector<int> counts = options.ranks;
  counts.push_back(kPatternRanks);
  Calibration calibration;
  for (const int ranks : counts) {
    const double units = calibrated_units(setting, ranks, side);
    if (calibration.share.empty()) calibration.total_units = units;
    calibration.share[ranks] = units / calibration.total_units;
  }
  PaperRun last;
  last.ranks = options.ranks.back(), last.side = side, last.share = calibration.share.at(last.ranks);
  calibration.frame_s = budget(calibration.total_units, last) / machine_of(options).units_per_second;
  return calibration;
}

void add_simple_and_casting(const PaperOptions& options, const Calibration& calibration, const PaperRun& base,
                            std::vector<PaperRun>& runs) {
  const std::array modes = {BalanceMode::kNone, BalanceMode::kLocal, BalanceMode::kGlobal,
                            BalanceMode::kCombined};
  for (const int ranks : options.ranks) {
    for (const BalanceMode mode : modes) {
      PaperRun& run = runs.emplace_back(base);
      run.experiment = kSimple, run.ranks = ranks, run.balance = mode;
      run.share = calibration.share.at(ranks);
    }
  }
  PaperRun again = base;
  again.share = calibration.share.at(options.ranks.front());
  again.experiment = kRepeat, again.ranks = options.ranks.front(), again.frames = std::min(5, base.frames);
  again.compare_serial = false;
  runs.push_back(again);
  for (const BalanceMode mode : {BalanceMode::kNone, BalanceMode::kLocal, BalanceMode::kCombined}) {
    for (const bool keep : {false, true}) {
      if (keep && mode != BalanceMode::kCombined) continue;
      PaperRun& run = runs.emplace_back(base);
      run.experiment = run.sequence = kCasting, run.ranks = options.ranks.back(), run.balance = mode;
      run.cast = CastChoice::kPaper, run.keep_samples = keep;
      run.share = calibration.share.at(run.ranks);
    }
  }
}

void add_scaling(const PaperOptions& options, const Calibration& calibration, PaperRun base,
                 std::vector<PaperRun>& runs) {
  base.frames = std::min(base.frames, kStillFrames);
  const std::vector<int> counts = options.quick ? std::vector{1, 2, 4} : std::vector{1, 2, 4, 8, 16, 32, 64};
  for (const int ranks : counts) {
    for (const int side : {base.side, 2 * base.side}) {
      for (const BalanceMode mode : {BalanceMode::kNone, BalanceMode::kLocal, BalanceMode::kCombined}) {
        if (side != base.side && mode != BalanceMode::kCombined) continue;
        PaperRun& run = runs.emplace_back(base);
        run.experiment = kScaling, run.ranks = ranks, run.side = side, run.balance = mode;
        run.compare_serial = side == base.side;
      }
      PaperRun& alone = runs.emplace_back(base);
      alone.experiment = kShortFrame, alone.side = side, alone.share = 1.0 / ranks;
      alone.compare_serial = false;
    }
    PaperRun& costs = runs.emplace_back(base);
    costs.experiment = kCosts, costs.sequence = kCasting, costs.ranks = ranks;
    costs.cast = CastChoice::kPaper, costs.compare_serial = false;
  }
  for (const BalanceMode mode : {BalanceMode::kNone, BalanceMode::kCombined}) {
    PaperRun& run = runs.emplace_back(base);
    run.experiment = kPattern, run.ranks = kPatternRanks, run.balance = mode;
    run.share = calibration.share.at(kPatternRanks);
  }
  for (const CastChoice cast : {CastChoice::kOff, CastChoice::kPaper}) {
    PaperRun& run = runs.emplace_back(base);
    run.experiment = kGrowth, run.sequence = kCasting, run.cast = cast, run.compare_serial = false;
  }
}

// Latencies as shares of a frame's time, and bandwidths as bytes that pass in it: so they ask the same of
// every machine.
void add_network(const PaperOptions& options, const Calibration& calibration, PaperRun base,
                 std::vector<PaperRun>& runs) {
  base.frames = std::min(base.frames, kStillFrames);
  base.ranks = options.ranks.back(), base.share = calibration.share.at(base.ranks);
  base.compare_serial = false;
  for (const double share : {0.0, 0.001, 0.01, 0.03, 0.1, 0.2, 0.4, 0.8}) {
    PaperRun& run = runs.emplace_back(base);
    run.experiment = kLatency, run.machine.latency_s = share * calibration.frame_s;
  }
  for (const double bytes : {1e8, 1e6, 1e5, 3e4, 1e4, 3e3, 1e3}) {
    PaperRun& run = runs.emplace_back(base);
    run.experiment = kBandwidth, run.machine.bytes_per_second = bytes / calibration.frame_s;
  }
}

}  // namespace

int picture_side(const PaperOptions& options) {
  return options.quick ? kQuickSide : kPaperSide;
}

std::string_view to_word(BalanceMode mode) {
  switch (mode) {
    case BalanceMode::kNone:
      return "none";
    case BalanceMode::kLocal:
      return "local";
    case BalanceMode::kGlobal:
      return "global";
    case BalanceMode::kCombined:
      return "combined";
  }
  return "";
}

Machine machine_of(const PaperOptions& options) {
  if (options.machine != "cluster" && options.machine != "sp2") {
    throw UsageError("--machine " + options.machine + ": want cluster or sp2");
  }
  Machine machine = options.machine == "sp2" ? sp2_machine() : cluster_machine();
  if (!std::isnan(options.latency_us)) machine.latency_s = options.latency_us * 1e-6;
  if (!std::isnan(options.bandwidth_mb_s)) machine.bytes_per_second = options.bandwidth_mb_s * 1e6;
  return machine;
}

PaperOptions settled(PaperOptions options) {
  machine_of(options);
  if (options.ranks.empty()) options.ranks = options.quick ? std::vector{4, 6} : std::vector{32, 62};
  if (options.frames == 0) options.frames = options.quick ? 6 : 40;
  return options;
}

std::vector<PaperRun> paper_runs(const PaperOptions& options, const Calibration& calibration) {
  PaperRun base;
  base.side = picture_side(options);
  base.frames = options.frames;
  base.machine = machine_of(options);
  std::vector<PaperRun> runs;
  add_simple_and_casting(options, calibration, base, runs);
  add_scaling(options, calibration, base, runs);
  add_network(options, calibration, base, runs);
  return runs;
}

PaperResults run_paper(const PaperOptions& options, const std::function<void(const std::string&)>& tell) {
  const CompiledScene scene =
      compile(make_spd("tree", options.quick ? std::optional(kQuickTree) : std::nullopt));
  Setting setting{options, scene, parse_animation(kTreeSimple, "tree-simple.anim").animation,
                  parse_animation(kTreeCasting, "tree-casting.anim").animation};
  PaperResults results;
  results.calibration = calibrate(setting);
  setting.total_units = results.calibration.total_units;
  for (const PaperRun& run : paper_runs(options, results.calibration)) {
    const auto begin = std::chrono::steady_clock::now();
    results.runs.push_back(carry_out(setting, run, [&](const FinishedFrame& frame) {
      std::vector<Picture> pictures = pictures_of(options, run, frame);
      std::move(pictures.begin(), pictures.end(), std::back_inserter(results.pictures));
    }));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    tell(fmt::format("{}: {}x{}, {} ranks, {}: {} frames in {:.1f} s", run.experiment, run.side, run.side,
                     run.ranks, to_word(run.balance), run.frames, took.count()));
  }
  results.cast_errors = run_cast_trial(cast_trial(options), tell);
  return results;
}

}  // namespace pprt
