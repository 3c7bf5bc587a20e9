// pprt-study balance: the figures of recorded runs, and maps of who owned which tile.
#pragma once

#include <string>
#include <vector>

namespace pprt {

struct BalanceOptions {
  std::vector<std::string> files;  // traces, at least one
  std::string directory;           // for tables, plots and index.html; empty: none
  std::vector<int> frames;         // whose regions are drawn; empty: the first, the middle and the last
  bool json = false;
};

// Prints a row for each frame, then a summary of each trace; with `json` an object a line. With several
// traces the row of a frame holds the deviation of each. Writes into the directory where there is one. Throws
// UsageError for traces of equal names and unknown frames, InputError for a file that is no trace.
void study_balance(const BalanceOptions& options, const std::string& command_line);

}  // namespace pprt
