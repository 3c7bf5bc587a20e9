// How far from the truth pictures are under each way of carrying samples to the next frame: against frames of
// many samples a pixel, for a picture made of more samples need not be a better one.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "parallel/session_settings.h"
#include "study/report/table.h"

namespace pprt {

struct PaperOptions;

inline constexpr std::array kCastWays = {CastChoice::kOff, CastChoice::kPaper, CastChoice::kVerified,
                                         CastChoice::kAuto};

// A turn round one of the databases, scenes/NAME-turn.anim.
struct CastSequence {
  std::string_view scene;
  double speed = 1;  // of the script's, in its frames a frame
};

// Errors are root mean squares over pixels and channels on the display scale, means over the frames judged.
struct CastErrors {
  CastSequence sequence;
  double samples_per_pixel = 1;                 // that a frame's work is meant for, when none is carried
  std::array<double, kCastWays.size()> rmse{};  // in the order of kCastWays

  // Of kAuto over the best of the others.
  double auto_ratio() const;
};

// What is run, and how it is judged.
struct CastTrial {
  std::vector<CastSequence> sequences;
  std::vector<double> densities;  // samples a pixel, for each of these
  int side = 192;                 // of the picture, pixels
  std::vector<int> judged;        // frames, increasing; the last one judged is the last one run
  int reference_side = 5;         // converged frames have the square of this of samples a pixel
  std::uint64_t seed = 1;
};

// What settled options ask for.
CastTrial cast_trial(const PaperOptions& options);

// On one rank under the work clock, as many sequences at a time as the host has cores. Tells of each when it
// is done, one at a time. Throws std::runtime_error.
std::vector<CastErrors> run_cast_trial(const CastTrial& trial,
                                       const std::function<void(const std::string&)>& tell);

Table cast_errors_table(const std::vector<CastErrors>& errors);

// How the trial was made, for people.
std::string cast_trial_text(const CastTrial& trial);

std::string_view to_word(CastChoice cast);

}  // namespace pprt
