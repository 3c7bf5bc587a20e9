// What probes have found of a picture's error: plain values that travel with a rank's report.
#pragma once

#include <cstdint>

namespace pprt {

// Sums over the pixels of a region. A pixel's squared error is the mean over its channels, on the display
// scale.
struct ErrorSums {
  double squared = 0;         // estimate of the sum of squared errors; chance may make it negative
  double variance = 0;        // of that estimate
  double third = 0;           // third central moment of that estimate
  double unexpected = 0;      // part of `squared` at pixels around which the picture shows nothing
  double pixels = 0;          // of the region; 0: nothing was measured
  std::uint64_t probes = 0;   // pixels at which the error was measured
  std::uint64_t samples = 0;  // eye rays for that
  std::uint64_t rays = 0;     // rays of all kinds for that
};

}  // namespace pprt
