// What a frame's time is good for, as a sampler is told.
#pragma once

#include <functional>

namespace pprt {

// Told when the first samples of a frame in real time are there.
struct TimeForecast {
  double samples = 0;      // that there would be at its end, if nothing took time but them
  double mixed_pixel = 0;  // of a pixel that shows several surfaces: samples that take as long as painting it
  double sample_s = 0;     // CPU time of a sample
  std::function<double()> used_s = {};  // tells the CPU time so far; empty: unknown
  std::function<void()> pause = {};     // to be called now and then during long work: messages wait
};

}  // namespace pprt
