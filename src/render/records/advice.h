// What would help a run on this machine whose frames are late or coarse.
#pragma once

#include <string>

namespace pprt {

// A run, by its measured figures.
struct RunFigures {
  double frames_per_second = 0;  // asked for; 0: no rate
  int frames = 0;
  int late = 0;                  // of the frames
  double late_p95_ms = 0;        // the latest of 95 % of the frames; below 0: early
  double least_rmse = 0;         // lower end of the measured error's interval
  double samples_per_pixel = 0;  // mean of the frames
  int width = 0, height = 0;     // pixels
  int ranks = 1;
  int cores = 1;  // of this host
};

// What the reader can change: the options of the next run, or the controls of the live page.
enum class Remedies { kOptions, kPage, kPageOfFixedSize };

// Returns one line, or nothing where there is no rate, few frames are late and the error is small.
std::string advice_on(const RunFigures& run, Remedies remedies = Remedies::kOptions);

}  // namespace pprt
