// pprt-study paper: the paper's experiments repeated, as tables, plots and a page of findings.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/words.h"
#include "parallel/settings/session_words.h"
#include "study/report/plot.h"

namespace pprt {

// What the work clock simulates.
enum class MachineKind : std::uint8_t { kCluster, kSp2 };

template <>
inline constexpr std::array<Word<MachineKind>, 2> kWords<MachineKind>{{
    {MachineKind::kCluster, "cluster", "a present-day core for each rank"},
    {MachineKind::kSp2, "sp2", "the IBM SP2 of the paper's runs"},
}};

struct PaperOptions {
  std::string directory;
  bool quick = false;      // small pictures of a small tree, few ranks and frames
  std::vector<int> ranks;  // for figures 5 to 7; empty: 32 and 62, or 4 and 6 if quick
  int most_ranks = 256;    // where their number varies, on the largest picture; up to 1024
  int frames = 0;          // of each sequence; 0: all 40, or 6 if quick
  WeightRule weights = WeightRule::kPaper;
  MachineKind machine = MachineKind::kCluster;
  double latency_us = kNoValue;      // NaN: the machine's
  double bandwidth_mb_s = kNoValue;  // megabytes per second; NaN: the machine's
  std::uint64_t seed = 1;
};

// Returns the options with all defaults filled in.
PaperOptions settled(PaperOptions options);

// Writes into options.directory and reports progress on standard error. `command_line` goes into the
// provenance. Throws std::runtime_error where nothing can be written.
void study_paper(const PaperOptions& options, const std::string& command_line);

}  // namespace pprt
