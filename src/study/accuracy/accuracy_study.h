// pprt-study accuracy: what a better picture costs in time, for this renderer and for what one would use
// instead, as tables, plots and a page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pprt {

struct AccuracyOptions {
  std::vector<std::string> inputs;  // scenes, and at most one animation script, FILE.anim; no scene: the
                                    // script's, without one tree, gears, balls and tetra
  std::string directory;
  std::string cache;      // of converged frames; empty: the user's cache directory
  bool no_cache = false;  // keep nothing, take nothing kept
  bool quick = false;     // small pictures, a trial of some seconds
  int size = 0;           // of pictures, pixels square; 0: 512, or when quick 96
  int repeats = 3;        // of each measurement
  int reference_cells =
      0;                   // converged frames have twice the square of this of samples a pixel; 0: 8, quick 4
  int ranks = 1;           // of the sequences at a fixed rate
  std::uint64_t seed = 1;  // of the first repeat
  std::optional<double> want_rmse, want_fps;  // answer what the other will be
};

// The options with what they leave open filled in.
AccuracyOptions settled(AccuracyOptions options);

// Where converged frames are kept; empty: nowhere.
std::filesystem::path cache_directory(const AccuracyOptions& options);

// Writes into options.directory, telling on standard error how far it is; `command_line` is told as it is.
// What is wanted of a rate or an error is answered on standard output: then a directory need not be given.
// Throws UsageError for two scripts or no directory, InputError for a scene that cannot be read or has no
// view, std::runtime_error where nothing can be written.
void study_accuracy(const AccuracyOptions& options, const std::string& command_line);

}  // namespace pprt
