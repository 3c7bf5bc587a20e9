// pprt-study balance: a balancing trace replayed under several policies.
#pragma once

#include <string>
#include <vector>

namespace pprt {

struct BalanceOptions {
  std::string file;         // the trace
  std::string policies;     // words with commas; empty: all
  std::string directory;    // for tables, plots and index.html; empty: none
  std::vector<int> frames;  // whose regions are drawn; empty: the first, the middle and the last
  bool json = false;
};

// Returns the words of all policies, which are those of pprt-render --balance.
std::vector<std::string> policy_words();

// Prints a row for each frame and policy, then a summary of each policy; with `json` an object a line. Writes
// into the directory where there is one. Throws UsageError for an unknown policy or frame, InputError for a
// file that is no trace.
void study_balance(const BalanceOptions& options, const std::string& command_line);

}  // namespace pprt
