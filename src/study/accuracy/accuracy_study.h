// pprt-study accuracy: what a better picture costs in time, for this renderer and for the alternatives.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "parallel/settings/session_settings.h"

namespace pprt {

struct AccuracyOptions {
  std::vector<std::string> inputs;  // scenes, and at most one script FILE.anim; without a scene: the
                                    // script's, or tree, gears, balls and tetra
  std::string directory;
  std::string cache;                             // of converged frames; empty: in the user's cache directory
  bool no_cache = false;                         // neither read nor write converged frames
  bool quick = false;                            // small pictures, a trial of some seconds
  int size = 0;                                  // of pictures, pixels square; 0: 512, or 96 if quick
  int repeats = 0;                               // of each measurement; 0: 3, or 1 if quick
  int reference_cells = 0;                       // n of converged_reference(); 0: 8, or 4 if quick
  int ranks = 1;                                 // of the sequences at fixed rates
  SamplerChoice sampler = SamplerChoice::kAuto;  // of them, too
  std::uint64_t seed = 1;                        // of the first repeat
  std::string methods;                           // words of methods_of(); empty: all
  bool only_curves = false;                      // of one picture and of its flicker, nothing else
  int busy_threads = 0;                          // render beside every picture of the curves
  std::optional<double> want_rmse, want_fps;     // the planner's questions
};

// Writes into options.directory and reports progress on standard error. `command_line` goes into the
// provenance. Answers the planner's questions on standard output; then the directory may be empty. Throws
// UsageError for two scripts, an unknown method or no directory, InputError for a scene that cannot be read
// or has no view, std::runtime_error where nothing can be written.
void study_accuracy(const AccuracyOptions& options, const std::string& command_line);

}  // namespace pprt
