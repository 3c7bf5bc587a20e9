// Error at a fixed frame rate: what each rate is worth, for every way of casting; and the planner that
// answers which rate goes with which error.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "parallel/session_settings.h"
#include "scene/animation.h"
#include "study/accuracy/methods.h"
#include "study/report/table.h"

namespace pprt {

struct Shot {
  Camera camera;
  bool cut = false;  // nothing leads from the frame before to it
};

// The script's frames, the first `most` of them; without a script six that go round the scene's target by
// two degrees a frame, with a jump in the middle. Pictures of size x size pixels.
std::vector<Shot> sequence_of(const CompiledScene& scene, const View& view, const Animation* script, int size,
                              int most);

// Frames that go round the scene's target at one speed whatever the rate, 14.4 degrees a second: at 24 frames
// a second as slowly as films do, so that most of a frame was seen in the one before.
std::vector<Shot> orbit_of(const CompiledScene& scene, const View& view, int size, double fps, int frames);

struct RateSettings {
  std::vector<double> rates = {1, 2, 4, 8, 15, 24, 30, 60};  // frames a second
  std::vector<CastChoice> casts = {CastChoice::kOff, CastChoice::kPaper, CastChoice::kVerified,
                                   CastChoice::kAuto};
  int ranks = 1;
  double units_per_second = 1e9;  // of the work clock, each rank
  std::uint64_t seed = 1;
};

// A sequence at one rate. Errors are of frames on the display scale, against converged ones.
struct RatePoint {
  std::string scene;
  CastChoice cast = CastChoice::kOff;
  double fps = 1;
  double rmse = 0;            // mean over the frames
  double rmse_after_cut = 0;  // mean over the first frames after a cut, the sequence's first among them
  double recovery = 0;        // frames after a cut until the error is within 10 % of the other frames' median
  double flicker = 0;         // error of the change from frame to frame over the reference's own change
  double samples = 0;         // a pixel and frame
};

// A sequence at one rate in real time.
struct Punctuality {
  std::string scene;
  CastChoice cast = CastChoice::kAuto;
  double fps = 1;
  int ranks = 1;
  int frames = 0;
  double on_time = 1;                                                         // share of the frames
  double late_p50_ms = 0, late_p95_ms = 0, late_p99_ms = 0, late_max_ms = 0;  // below 0: early
  double rmse = 0;                                                            // mean over the frames
  double samples = 0;                                                         // a pixel and frame
  double fewest_samples = 0;  // of any frame after the fifth, when balancing has settled
  double uniform_rmse = 0;    // uniform_rmse_in() the ranks' time, if that was measured
};

// Work units that a rank does in a second of this machine's CPU on this scene.
double measured_units_per_second(const Subject& subject);

// Under the work clock, as many runs at a time as the host has cores. `references`: a converged frame each.
std::vector<RatePoint> measure_rates(const std::string& name, const CompiledScene& scene,
                                     const std::vector<Shot>& shots, const std::vector<Image>& references,
                                     const RateSettings& settings);

// In real time on this machine, one rate after the other, the sequence again and again for two seconds at
// least.
std::vector<Punctuality> measure_punctuality(const std::string& name, const CompiledScene& scene,
                                             const std::vector<Shot>& shots,
                                             const std::vector<Image>& references,
                                             const RateSettings& settings);

// A sequence's figures from its frames' pictures.
void judge_sequence(const std::vector<Shot>& shots, const std::vector<Image>& pictures,
                    const std::vector<Image>& references, RatePoint& point);

// A sequence in real time at one rate, by one way of casting; nothing of uniform grids.
Punctuality measure_in_real_time(const std::string& name, const CompiledScene& scene,
                                 const std::vector<Shot>& shots, const std::vector<Image>& references,
                                 const RateSettings& settings, CastChoice cast, double fps);

// The fewest samples of any frame after the fifth; of the last one where there are no more.
double fewest_after_fifth(std::span<const double> samples_of_frames);

// Mean error of the frames by uniform grids that have so many seconds of one thread for each: ranks that
// share a frame have their number times its time, if they lost none of it.
double uniform_rmse_in(double seconds, const CompiledScene& scene, const std::vector<Shot>& shots,
                       const std::vector<Image>& references);

// In a sentence what a sequence did in real time, turn by turn with casting, without, and by uniform grids.
// The error is the median, and the ratios are medians of those of a turn.
std::string plan_in_real_time(std::span<const Punctuality> with, std::span<const Punctuality> without,
                              std::span<const double> uniform_rmse);

// What is wanted of a sequence: one of the two.
struct Wish {
  std::optional<double> rmse;
  std::optional<double> fps;
};

// In a sentence what the other will be, from the points of --cast auto.
std::string plan(const std::string& scene, const std::vector<RatePoint>& points, const Wish& wish);

Table rates_table(const std::vector<RatePoint>& points);
Table punctuality_table(const std::vector<Punctuality>& points);

}  // namespace pprt
