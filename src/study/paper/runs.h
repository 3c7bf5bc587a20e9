// The experiments of the paper (Reisman, Gotsman, Schuster, JPDC 60, 2000, section 6): which runs they take,
// and what each frame of a run measured.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "render/records/frame_summary.h"
#include "study/frame_series.h"
#include "study/paper/casting_errors.h"
#include "study/paper/paper_study.h"
#include "study/report/page.h"

namespace pprt {

// Samples in a frame of the paper, at 256 x 256 pixels. Other sizes get as many per pixel.
inline constexpr double kPaperSamples = 19'000;
inline constexpr int kPaperSide = 256;   // pixels
inline constexpr int kPatternRanks = 9;  // as in the paper's figure 2

// Names of experiments in the tables.
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

// Figures of one frame (paper s. 6.2): the ledger's, and those that only the study measures.
struct FrameMeasures : FrameSummary {
  double distance = kNoValue;        // to the serial pattern, 0 to 1
  double border_density = kNoValue;  // samples near borders of regions / those of the serial pattern
  std::string picture_hash = "";
};

struct MeasuredRun : PaperRun {
  std::vector<FrameMeasures> frames = {};
};

// Work of a frame that makes kPaperSamples samples of it. Where the number of ranks varies (figures 8 and 9)
// all runs do the work of the first.
struct Calibration {
  double total_units = 0;       // all ranks together, for the first of the options' numbers of ranks
  std::map<int, double> share;  // number of ranks -> its work / total_units
  double frame_s = 0;           // duration of a frame on the machine, for the last number of ranks
};

struct PaperResults {
  Calibration calibration = {};
  std::vector<MeasuredRun> runs = {};
  std::vector<Picture> pattern_pictures = {};   // figures 1 and 2
  std::vector<Picture> sequence_pictures = {};  // figure 4
  std::vector<CastingErrors> casting_errors = {};
};

// Returns the side of the smaller pictures, pixels.
int picture_side(const PaperOptions& options);

// Returns the machine with the options' network.
Machine machine_of(const PaperOptions& options);

// Returns the runs that settled options ask for, in the order of the tables.
std::vector<PaperRun> paper_runs(const PaperOptions& options, const Calibration& calibration);

// Returns the settings of a run. `total_units`: work of a frame of the paper's size, of all ranks together.
SessionSettings settings_of_run(const PaperRun& run, double total_units, const PaperOptions& options);

// Adds the pictures of the paper's figures 1, 2 and 4 that show this frame of the run, if any. `run` must
// have asked for its samples.
void add_pictures(const PaperOptions& options, const PaperRun& run, const FinishedFrame& frame,
                  PaperResults& results);

// Makes all runs that settled options ask for. Calls `report` with a line on each when it is done. Throws
// std::runtime_error.
PaperResults run_paper(const PaperOptions& options, const std::function<void(const std::string&)>& report);

// The same without the casting trial.
PaperResults run_experiments(const PaperOptions& options,
                             const std::function<void(const std::string&)>& report);

}  // namespace pprt
