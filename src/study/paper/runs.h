// The paper's experiments (Reisman, Gotsman, Schuster, JPDC 60, 2000, section 6) as runs of virtual ranks:
// what is run, and what each frame of it measured.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "parallel/master.h"
#include "study/cast_errors.h"
#include "study/report/plot.h"

namespace pprt {

// The paper's samples a frame, at its 256 x 256 pixels; larger pictures get as many a pixel.
inline constexpr double kPaperSamples = 19'000;
inline constexpr int kPaperSide = 256;  // pixels

struct PaperOptions {
  std::string directory;
  bool quick = false;      // a small picture of a small tree, few ranks and frames
  std::vector<int> ranks;  // of figures 5 to 7; empty: 32 and 62, or when quick 4 and 6
  int frames = 0;          // of each sequence; 0: all 40, or when quick 6
  std::string machine = "cluster";
  double latency_us = kNoValue;      // kNoValue: the machine's
  double bandwidth_mb_s = kNoValue;  // megabytes a second
  std::uint64_t seed = 1;
};

// Names of experiments, as they stand in the tables.
inline constexpr std::string_view kSimple = "simple";             // figures 5 and 6
inline constexpr std::string_view kCasting = "casting";           // figure 7
inline constexpr std::string_view kPattern = "pattern";           // figure 2: few ranks
inline constexpr std::string_view kScaling = "scaling";           // figure 8
inline constexpr std::string_view kShortFrame = "one rank, 1/p";  // figure 8: Refine(1, f)
inline constexpr std::string_view kCosts = "costs";               // figures 9a and 9b
inline constexpr std::string_view kGrowth = "growth";             // figure 9c
inline constexpr std::string_view kLatency = "latency";
inline constexpr std::string_view kBandwidth = "bandwidth";
inline constexpr std::string_view kRepeat = "repeat";

// One run: which sequence on which ranks, and how.
struct PaperRun {
  std::string_view experiment;
  std::string_view sequence = kSimple;  // or kCasting
  int ranks = 1;
  int side = kPaperSide;  // of the picture, pixels
  int frames = 40;
  BalanceMode balance = BalanceMode::kCombined;
  CastChoice cast = CastChoice::kOff;
  bool keep_samples = true;
  double share = 1;  // of the calibrated work
  bool compare_serial = true;
  Machine machine;
};

// What one frame measured (paper s. 6.2), sums over ranks where nothing else is said.
struct FrameMeasures {
  int frame = 0;
  double refinement = 0;             // mean over ranks of Q_k
  double deviation = 0;              // standard deviation over ranks of Q_k
  double distance = kNoValue;        // to the serial pattern, 0 .. 1
  double border_density = kNoValue;  // samples near borders of regions, over the serial pattern's there
  double samples = 0;
  double samples_cast = 0;
  double samples_received = 0;
  bool repartitioned = false;  // the image was cut anew for this frame
  double late_ms = 0;
  StageTimes cpu_ms;
  double bytes_samples = 0, bytes_progress = 0, bytes_balance = 0, bytes_pixels = 0;
  std::string picture_hash;
};

struct MeasuredRun {
  PaperRun run;
  std::vector<FrameMeasures> frames;
};

struct Picture {
  bool of_pattern = false;  // of figures 1 and 2; otherwise of figure 4
  std::string caption;
  std::string png;
};

// The work of a frame, all ranks together, that makes kPaperSamples samples of it. Where the number of ranks
// varies (figures 8 and 9) all do that of the first.
struct Calibration {
  double total_units = 0;       // on the first of the options' ranks
  std::map<int, double> share;  // of it, on so many ranks
  double frame_s = 0;           // what a frame lasts on the machine, on the last of the options' ranks
};

struct PaperResults {
  Calibration calibration;
  std::vector<MeasuredRun> runs;
  std::vector<Picture> pictures;
  std::vector<CastErrors> cast_errors;
};

// Of the smaller pictures, pixels.
int picture_side(const PaperOptions& options);

std::string_view to_word(BalanceMode mode);

// The options with what they leave open filled in. Throws UsageError for a machine that there is not.
PaperOptions settled(PaperOptions options);

// Which runs settled options ask for.
std::vector<PaperRun> paper_runs(const PaperOptions& options, const Calibration& calibration);

// The machine by its name, "cluster" or "sp2", with what the options set otherwise. Throws UsageError.
Machine machine_of(const PaperOptions& options);

// Carries out all that settled options ask for; tells of each run when it is done. Throws std::runtime_error.
PaperResults run_paper(const PaperOptions& options, const std::function<void(const std::string&)>& tell);

}  // namespace pprt
