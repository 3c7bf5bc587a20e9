#include "study/paper/runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/content_hash.h"
#include "base/counted.h"
#include "parallel/balance/partition.h"
#include "parallel/serial_pattern.h"
#include "parser/anim/anim_parser.h"
#include "spd/spd.h"
#include "study/sequences.h"
#include "study/stopwatch.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

constexpr double kNearBorder = 3;    // pixels: within this a sample counts as near a border of regions
constexpr int kManyRanksFrames = 6;  // enough to settle
constexpr int kStillFrames = 10;     // the camera rests this long at the start of the simple sequence

// What all runs have in common.
struct PaperSetup {
  const PaperOptions& options;
  CompiledScene scene;
  Animation simple, casting;
};

double pixels_of(int side) {
  return static_cast<double>(side) * side;
}

// Work units of a rank and frame. Grows with the picture, so that there are as many samples per pixel.
double budget(double total_units, const PaperRun& run) {
  return run.share * total_units * pixels_of(run.side) / pixels_of(kPaperSide) / run.ranks;
}

std::string hash_of(const Image& image) {
  const auto* bytes = reinterpret_cast<const char*>(image.pixels.data());
  return content_hash({bytes, image.pixels.size() * sizeof(Color)});
}

void compare_with_serial(const FinishedFrame& frame, const SessionSettings& settings, int ranks,
                         const Probe& probe, FrameMeasures& measures) {
  const std::vector<Sample> serial =
      serial_samples(settings, frame.order.camera, frame.order.time, frame.samples.size(), probe);
  measures.distance = bucket_distance(frame.samples, serial);
  const TileGrid grid = tile_grid_for(settings.width, settings.height, ranks);
  const auto near = [&](const std::vector<Sample>& samples) {
    return static_cast<double>(samples_near_borders(samples, grid, frame.owners, kNearBorder));
  };
  if (const double expected = near(serial); expected > 0)
    measures.border_density = near(frame.samples) / expected;
}

MeasuredRun carry_out(const PaperSetup& setup, const PaperRun& run, double total_units,
                      const std::function<void(const FinishedFrame&)>& watch = {}) {
  const Animation& animation = run.sequence == kSimple ? setup.simple : setup.casting;
  const SessionSettings settings = settings_of_run(run, total_units, setup.options);
  Tracer serial_tracer(setup.scene, Camera());
  MeasuredRun measured{run};
  render_series(setup.scene, frames_of(setup.scene, animation, run.frames, View(), run.side), run.ranks,
                settings, [&](FinishedFrame&& frame) {
                  FrameMeasures& measures = measured.frames.emplace_back(FrameMeasures{summarize(frame)});
                  measures.picture_hash = hash_of(frame.image);
                  if (run.compare_serial) {
                    compare_with_serial(frame, settings, run.ranks, probe_of(serial_tracer), measures);
                  }
                  if (watch) watch(frame);
                });
  return measured;
}

// Returns the work that makes the paper's number of samples on `ranks` ranks, for a picture of the paper's
// size.
double calibrated_units(const PaperSetup& setup, int ranks) {
  const PaperRun run{.experiment = "calibration",
                     .ranks = ranks,
                     .side = picture_side(setup.options),
                     .frames = 5,
                     .compare_serial = false,
                     .machine = machine_of(setup.options)};
  const WorkQuestion question{.samples = kPaperSamples,
                              .guess_per_sample = 1400,
                              .pixel_units = pixels_of(kPaperSide) * static_cast<double>(price(Work::kPixel)),
                              .corrections = 2};
  return work_for_samples(question, [&](double units) {
    const std::vector<FrameMeasures> frames = carry_out(setup, run, units).frames;
    const double made = 0.5 * static_cast<double>(frames[3].samples + frames[4].samples);
    return made * pixels_of(kPaperSide) / pixels_of(run.side);
  });
}

Calibration calibrate(const PaperSetup& setup) {
  const PaperOptions& options = setup.options;
  std::vector<int> counts = options.ranks;
  counts.push_back(kPatternRanks);
  Calibration calibration;
  for (const int ranks : counts) {
    const double units = calibrated_units(setup, ranks);
    if (calibration.share.empty()) calibration.total_units = units;
    calibration.share[ranks] = units / calibration.total_units;
  }
  PaperRun last;
  last.ranks = options.ranks.back(), last.side = picture_side(options);
  last.share = calibration.share.at(last.ranks);
  calibration.frame_s = budget(calibration.total_units, last) / machine_of(options).units_per_second;
  return calibration;
}

// Lists the runs, experiment by experiment.
struct RunList {
  const PaperOptions& options;
  const Calibration& calibration;
  std::vector<PaperRun> runs = {};

  PaperRun& add(std::string_view experiment, int ranks, BalanceMode balance = BalanceMode::kCombined) {
    PaperRun& run = runs.emplace_back();
    run.experiment = experiment, run.ranks = ranks, run.balance = balance;
    run.side = picture_side(options), run.frames = options.frames, run.machine = machine_of(options);
    return run;
  }
  // Only the frames in which the camera rests.
  PaperRun& add_still(std::string_view experiment, int ranks, BalanceMode balance = BalanceMode::kCombined) {
    PaperRun& run = add(experiment, ranks, balance);
    run.frames = std::min(run.frames, kStillFrames);
    return run;
  }
  // Lets the run do the work that was calibrated for its number of ranks.
  void calibrate(PaperRun& run) const { run.share = calibration.share.at(run.ranks); }

  void add_sequences() {
    using enum BalanceMode;
    for (const int ranks : options.ranks) {
      for (const BalanceMode mode : {kNone, kLocal, kGlobal, kCombined}) calibrate(add(kSimple, ranks, mode));
    }
    PaperRun& again = add(kRepeat, options.ranks.front());
    again.frames = std::min(5, again.frames), again.compare_serial = false;
    calibrate(again);
    for (const auto& [mode, keep] :
         {std::pair(kNone, false), {kLocal, false}, {kCombined, false}, {kCombined, true}}) {
      PaperRun& run = add(kCasting, options.ranks.back(), mode);
      run.sequence = kCasting, run.cast = CastChoice::kPaper, run.keep_samples = keep;
      calibrate(run);
    }
  }

  void add_scaling() {
    using enum BalanceMode;
    const int side = picture_side(options);
    for (const int ranks : options.quick ? std::vector{1, 2, 4} : std::vector{1, 2, 4, 8, 16, 32, 64}) {
      for (const BalanceMode mode : {kNone, kLocal, kCombined}) add_still(kScaling, ranks, mode);
      add_alone(side, ranks);
      PaperRun& large = add_still(kScaling, ranks);
      large.side = 2 * side, large.compare_serial = false;
      add_alone(2 * side, ranks);
      add_cast(kCosts, ranks, CastChoice::kPaper);
    }
    add_many_ranks();
    for (const BalanceMode mode : {kNone, kCombined}) calibrate(add_still(kPattern, kPatternRanks, mode));
    add_cast(kGrowth, 1, CastChoice::kOff);
    PaperRun& alone = add_cast(kGrowth, 1, CastChoice::kPaper);
    alone.frames = options.frames, alone.compare_serial = true;
  }

  // A picture large enough that regions stay as large as the paper's.
  void add_many_ranks() {
    if (options.quick) return;
    const int side = 4 * picture_side(options);
    for (const int ranks : {1, 64, 128, 256, 512, 1024}) {
      if (ranks > options.most_ranks) break;
      PaperRun& run = add_still(kScaling, ranks);
      run.side = side, run.frames = kManyRanksFrames, run.compare_serial = false;
      add_alone(side, ranks);
      runs.back().frames = kManyRanksFrames;
    }
  }

  PaperRun& add_cast(std::string_view experiment, int ranks, CastChoice cast) {
    PaperRun& run = add_still(experiment, ranks);
    run.sequence = kCasting, run.cast = cast, run.compare_serial = false;
    return run;
  }

  // One rank in the time that `ranks` have together.
  void add_alone(int side, int ranks) {
    PaperRun& run = add_still(kShortFrame, 1);
    run.side = side, run.share = 1.0 / ranks, run.compare_serial = false;
  }

  // Latencies are shares of a frame's time, bandwidths bytes per frame: the same demand on every machine.
  void add_network() {
    const auto add_run = [&](std::string_view experiment) -> Machine& {
      PaperRun& run = add_still(experiment, options.ranks.back());
      run.compare_serial = false;
      calibrate(run);
      return run.machine;
    };
    for (const double share : {0.0, 0.001, 0.01, 0.03, 0.1, 0.2, 0.4, 0.8}) {
      add_run(kLatency).latency_s = share * calibration.frame_s;
    }
    for (const double bytes : {1e8, 1e6, 1e5, 3e4, 1e4, 3e3, 1e3}) {
      add_run(kBandwidth).bytes_per_second = bytes / calibration.frame_s;
    }
  }
};

}  // namespace

PaperOptions settled(PaperOptions options) {
  if (options.ranks.empty()) options.ranks = options.quick ? std::vector{4, 6} : std::vector{32, 62};
  if (options.frames == 0) options.frames = options.quick ? 6 : 40;
  return options;
}

int picture_side(const PaperOptions& options) {
  constexpr int kQuickSide = 96;
  return options.quick ? kQuickSide : kPaperSide;
}

Machine machine_of(const PaperOptions& options) {
  Machine machine = options.machine == MachineKind::kSp2 ? sp2_machine() : cluster_machine();
  if (!std::isnan(options.latency_us)) machine.latency_s = options.latency_us * 1e-6;
  if (!std::isnan(options.bandwidth_mb_s)) machine.bytes_per_second = options.bandwidth_mb_s * 1e6;
  return machine;
}

SessionSettings settings_of_run(const PaperRun& run, double total_units, const PaperOptions& options) {
  SessionSettings s{.sampler = SamplerChoice::kDelaunay};
  s.width = s.height = run.side;
  s.clock = ClockKind::kWork;
  s.budget_units = static_cast<std::uint64_t>(budget(total_units, run));
  s.frames_per_second = run.machine.units_per_second / static_cast<double>(s.budget_units);
  s.balance = run.balance;
  s.cast = run.cast;
  s.keep_samples = run.keep_samples;
  s.learned_weights = options.weights == WeightRule::kLearned;
  s.seed = options.seed;
  s.report_samples = run.compare_serial;
  s.machine = run.machine;
  return s;
}

std::vector<PaperRun> paper_runs(const PaperOptions& options, const Calibration& calibration) {
  RunList list{options, calibration};
  list.add_sequences();
  list.add_scaling();
  list.add_network();
  return std::move(list.runs);
}

PaperResults run_experiments(const PaperOptions& options,
                             const std::function<void(const std::string&)>& report) {
  constexpr int kQuickTree = 5;
  const PaperSetup setup{options,
                         compile(make_spd("tree", options.quick ? std::optional(kQuickTree) : std::nullopt)),
                         parse_animation(kTreeSimple, "tree-simple.anim").animation,
                         parse_animation(kTreeCasting, "tree-casting.anim").animation};
  PaperResults results{calibrate(setup)};
  for (const PaperRun& run : paper_runs(options, results.calibration)) {
    Stopwatch watch;
    results.runs.push_back(
        carry_out(setup, run, results.calibration.total_units,
                  [&](const FinishedFrame& frame) { add_pictures(options, run, frame, results); }));
    report(fmt::format("{}: {}x{}, {}, {}: {} in {:.1f} s", run.experiment, run.side, run.side,
                       counted(run.ranks, "rank", "ranks"), word_for(run.balance),
                       counted(run.frames, "frame", "frames"), watch.lap()));
  }
  return results;
}

PaperResults run_paper(const PaperOptions& options, const std::function<void(const std::string&)>& report) {
  PaperResults results = run_experiments(options, report);
  results.casting_errors = run_casting_trial(casting_trial(options), report);
  return results;
}

}  // namespace pprt
