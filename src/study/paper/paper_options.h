// Options of pprt-study paper.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "parallel/clock/machine.h"
#include "study/report/plot.h"

namespace pprt {

struct PaperOptions {
  std::string directory;
  bool quick = false;      // small pictures of a small tree, few ranks and frames
  std::vector<int> ranks;  // for figures 5 to 7; empty: 32 and 62, or 4 and 6 if quick
  int frames = 0;          // of each sequence; 0: all 40, or 6 if quick
  std::string machine = "cluster";
  double latency_us = kNoValue;      // NaN: the machine's
  double bandwidth_mb_s = kNoValue;  // megabytes per second; NaN: the machine's
  std::uint64_t seed = 1;
};

// Returns the options with all defaults filled in. Throws UsageError for an unknown machine.
PaperOptions settled(PaperOptions options);

// Returns the side of the smaller pictures, pixels.
int picture_side(const PaperOptions& options);

// Returns the machine of that name, "cluster" or "sp2", with the options' network. Throws UsageError.
Machine machine_of(const PaperOptions& options);

}  // namespace pprt
