// The true error of pictures under each way of casting, against frames of many samples per pixel. A picture
// made of more samples need not be a better one.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "parallel/settings/session_words.h"
#include "study/paper/paper_study.h"
#include "study/report/table.h"

namespace pprt {

// A turn round an SPD scene, scenes/NAME-turn.anim.
struct TurnSequence {
  std::string_view scene;
  double speed = 1;  // frames of the script per frame
};

// Root mean square over pixels and channels on the display scale, mean over the judged frames.
struct CastingErrors {
  TurnSequence sequence;
  double samples_per_pixel = 1;                          // that a frame's work makes when none are cast
  std::array<double, kWords<CastChoice>.size()> rmse{};  // in the order of the words

  // The error of kAuto over the least of the others.
  double auto_ratio() const;
};

struct CastingTrial {
  std::vector<TurnSequence> sequences;
  std::vector<double> densities;  // samples per pixel
  int side = 192;                 // of the picture, pixels
  std::vector<int> judged;        // frames, increasing; runs end with the last one
  int reference_side = 5;         // converged frames have the square of this of samples per pixel
  WeightRule weights = WeightRule::kPaper;
  std::uint64_t seed = 1;
};

// Returns the trial that settled options ask for.
CastingTrial casting_trial(const PaperOptions& options);

// Plays every sequence at every density, on one rank under the work clock, several sequences at a time. Calls
// `report` for each sequence when it is done, never twice at a time. Throws what `report` or a rank throws.
std::vector<CastingErrors> run_casting_trial(const CastingTrial& trial,
                                             const std::function<void(const std::string&)>& report);

Table casting_errors_table(const std::vector<CastingErrors>& errors);

// Describes the trial in sentences.
std::string casting_trial_text(const CastingTrial& trial);

}  // namespace pprt
