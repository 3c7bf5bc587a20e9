// pprt-study rate: which frame rate shows a movement best on this machine.
#pragma once

#include <string>
#include <vector>

namespace pprt {

struct RateOptions {
  std::vector<std::string> inputs;  // a scene, a script, or both
  std::string directory;            // empty: no page
  bool quick = false;               // small pictures of a short time
  int size = 0;                     // of pictures, pixels square; 0: 192, or 64 if quick
  int ranks = 2;
  double seconds = 0;       // of the film that is judged; 0: 1, or 0.25 if quick
  int reference_cells = 0;  // n of converged_reference(); 0: 3, or 2 if quick
};

// Prints the best rates on standard output, and writes tables, plots and a page into options.directory.
// Throws UsageError where the inputs are no film, InputError for what cannot be read, std::runtime_error
// where nothing can be written.
void study_rate(const RateOptions& options, const std::string& command_line);

}  // namespace pprt
