// Figures of whole runs: means over frames and ratios between runs. NaN is what was not measured.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "study/paper/runs.h"
#include "study/report/table.h"

namespace pprt {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

// A range of frames, both ends included.
struct Frames {
  int first, last;
};

// Parts of the simple sequence.
inline constexpr Frames kStart = {1, 10}, kStill = {5, 10}, kAfterCameraCut = {31, 40}, kWhole = {1, 40};

// A member of FrameMeasures, or a function.
using FrameMeasure = std::function<double(const FrameMeasures&)>;

double relative_deviation(const FrameMeasures& m);   // deviation / mean of refinement
double received_per_sample(const FrameMeasures& m);  // other ranks that receive a sample, on average
double cpu_ms(const FrameMeasures& m);               // all stages
FrameMeasure time_of(double StageTimes::*stage);     // milliseconds
FrameMeasure kilobytes_of(std::uint64_t BytesSent::*kind);

// Mean over the frames of the range that were run.
double mean(const MeasuredRun& run, Frames frames, const FrameMeasure& measure);

// Frames of `part` until the mean relative deviation of the rest is at most `level`, counted from 1. kNever
// when it never is; NaN when `part` was not run to its end.
double frames_to_settle(const MeasuredRun& run, Frames part, double level);

// The greatest loss of samples at a repartition, as a share of the samples of the frame before.
double worst_loss(const MeasuredRun& run);

int repartitions(const MeasuredRun& run);

// A property of the network, and the experiment that varies it.
struct NetworkProperty {
  std::string_view experiment;
  const char* title;
  const char* unit;
  double Machine::*member;
  double units;  // in one of the member's

  double of(const Machine& machine) const { return units * machine.*member; }
};
inline constexpr std::array kNetworkProperties = {
    NetworkProperty{kLatency, "Latency", "microseconds", &Machine::latency_s, 1e6},
    NetworkProperty{kBandwidth, "Bandwidth of each rank", "MB/s", &Machine::bytes_per_second, 1e-6}};

// The runs of each experiment. A run that was not made has no frames.
class Runs {
 public:
  explicit Runs(const PaperResults& results) : results_(results) {}

  using Choice = std::function<bool(const PaperRun&)>;

  // All runs of the experiment that `choice` admits; find() returns the first of them.
  std::vector<const MeasuredRun*> all(std::string_view experiment, const Choice& choice = {}) const;
  const MeasuredRun& find(std::string_view experiment, const Choice& choice) const;
  const MeasuredRun& find(std::string_view experiment, int ranks, BalanceMode balance) const;

  // The distinct values of a member, increasing.
  std::vector<int> distinct(std::string_view experiment, int PaperRun::*member) const;

 private:
  const PaperResults& results_;
  MeasuredRun none_;
};

// The paper's AchievementSpeedup (figure 8): mean refinement of still frames on one rank over that on
// `ranks`.
struct Speedup {
  int ranks = 1;
  int side = 0;           // of the picture, pixels
  double same_frame = 0;  // Refine(1, f) / Refine(p, f), s. 6.3: one rank in the same frame time
  double same_work = 0;   // Refine(1, f/p) / Refine(p, f), s. 7.1: one rank in p times the time; 1 is ideal
};
std::vector<Speedup> speedups(const Runs& runs);  // by increasing side

// Returns one row for each frame of each run.
Table frames_table(const PaperResults& results);

}  // namespace pprt
