// Error of sequences at fixed frame rates, under the work clock and in real time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/frame_series.h"
#include "study/reference.h"
#include "study/report/plot.h"
#include "study/report/table.h"

namespace pprt {

// A sequence, what its frames are judged by, and how it is played.
struct Sequence {
  std::string name;  // of the scene
  const CompiledScene& scene;
  std::vector<FrameRequest> frames;
  std::vector<Image> references;  // converged, one per frame
  int ranks = 1;
  SamplerChoice sampler = SamplerChoice::kAuto;
  double units_per_second = 1e9;  // of the work clock, each rank
  std::uint64_t seed = 1;
  double played_s = 2;  // in real time, at least
};

// Returns `count` frames that go round the scene's target by equal steps. Frame `cut`, counted from 0, comes
// after a camera cut of 120 degrees; -1: none does. Pictures have size x size pixels.
std::vector<FrameRequest> orbit(const CompiledScene& scene, const View& view, int size, int count,
                                double degrees_per_frame, int cut = -1);

// A sequence at one rate under the work clock. Errors are on the display scale.
struct RatePoint {
  std::string scene;
  CastChoice cast = CastChoice::kOff;
  double fps = 1;
  double rmse = 0;            // mean over the frames
  double rmse_after_cut = 0;  // mean over the frames right after a camera cut, and the first
  double recovery = 0;  // frames from a camera cut until the error is within 10 % of the other frames' median
  double flicker = 0;   // error of the change between frames / the reference's change
  double samples = 0;   // per pixel and frame
};

// Mean errors of frames.
struct MeanErrors {
  double rmse = 0, flip = 0;
};

// A sequence at one rate in real time. Lateness below 0 is early.
struct RealTimePoint {
  std::string scene;
  CastChoice cast = CastChoice::kAuto;
  double fps = 1;
  int ranks = 1;
  int frames = 0;
  double on_time = 1;  // share of the frames
  double late_p50_ms = 0, late_p95_ms = 0, late_p99_ms = 0, late_max_ms = 0;
  MeanErrors errors = {};
  double samples = 0;         // per pixel and frame
  double fewest_samples = 0;  // of any frame after the fifth, when balancing has settled
  MeanErrors uniform = {};    // of grids that take all of the ranks' time
};

// Fills in the errors of a sequence's pictures. Throws std::invalid_argument unless each frame has one.
void judge_sequence(const Sequence& sequence, const std::vector<Image>& pictures, RatePoint& point);

// Plays the sequence at each rate with each way of casting, under the work clock, several runs at a time.
std::vector<RatePoint> measure_rates(const Sequence& sequence, std::span<const double> rates,
                                     std::span<const CastChoice> casts);

// Plays the sequence in real time, again and again. Leaves out `uniform`.
RealTimePoint measure_in_real_time(const Sequence& sequence, CastChoice cast, double fps);

// Plays it at each rate with auto casting, and adds the error of uniform grids.
std::vector<RealTimePoint> measure_in_real_time(const Sequence& sequence, std::span<const double> rates);

// Returns the fewest samples of any frame after the fifth; of the last one where there are no more.
double fewest_after_fifth(std::span<const double> samples_of_frames);

// Returns the errors of uniform grids that take `seconds` of one thread for each frame.
MeanErrors uniform_errors_in(double seconds, const Sequence& sequence);

Table rates_table(const std::vector<RatePoint>& points);
Table real_time_table(const std::vector<RealTimePoint>& points);

}  // namespace pprt
