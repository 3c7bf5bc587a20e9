// What the runs of the paper's experiments come to: means over frames and ratios between runs. What was not
// measured is kNoValue.
#pragma once

#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "study/paper/runs.h"

namespace pprt {

inline constexpr double kNever = std::numeric_limits<double>::infinity();

// From the first to the last, both included.
struct Frames {
  int first, last;
};

using Measure = std::function<double(const FrameMeasures&)>;

inline double relative_deviation(const FrameMeasures& m) {
  return m.deviation / m.refinement;
}
inline double distance(const FrameMeasures& m) {
  return m.distance;
}
inline double samples(const FrameMeasures& m) {
  return m.samples;
}
inline double refinement(const FrameMeasures& m) {
  return m.refinement;
}

// Of a sample, how many other ranks take it in.
inline double received_per_sample(const FrameMeasures& m) {
  return m.samples_received / m.samples;
}

// Milliseconds of all stages.
inline double cpu_ms(const FrameMeasures& m) {
  return m.cpu_ms.sampling + m.cpu_ms.casting + m.cpu_ms.reconstruction + m.cpu_ms.balancing;
}

double mean(const MeasuredRun& run, Frames frames, const Measure& measure);

// How many frames of the part pass until the relative deviation is down at `level` for good, its first frame
// counting as 1; kNever when it never is; kNoValue where the part was not run to its end.
double frames_to_settle(const MeasuredRun& run, Frames part, double level);

// The greatest loss of samples, 0 .. 1, from one frame to the next where the image was cut anew.
double worst_loss(const MeasuredRun& run);

// How often the image was cut anew.
int repartitions(const MeasuredRun& run);

// The results by experiment. A run that was not made is one without frames.
class Runs {
 public:
  explicit Runs(const PaperResults& results) : results_(results) {}

  std::vector<const MeasuredRun*> all(std::string_view experiment) const;
  const MeasuredRun& find(std::string_view experiment,
                          const std::function<bool(const PaperRun&)>& choice) const;
  const MeasuredRun& find(std::string_view experiment, int ranks, BalanceMode balance) const;

  // Increasing, each once.
  std::vector<int> ranks_of(std::string_view experiment) const;
  std::vector<int> sides_of(std::string_view experiment) const;

 private:
  const PaperResults& results_;
  MeasuredRun none_;
};

// Figure 8: what `ranks` achieve against one, by the mean refinement of still frames.
struct Speedup {
  int ranks = 1;
  int side = 0;       // of the picture, pixels
  double first = 0;   // Refine(1, f) / Refine(p, f), s. 6.3: the rank alone has as much time a frame
  double turned = 0;  // Refine(1, f/p) / Refine(p, f), s. 7.1: it has p times as much; 1 is ideal
};
std::vector<Speedup> speedups(const Runs& runs);

}  // namespace pprt
