// What a replay of several policies is judged by.
#pragma once

#include <string>
#include <vector>

#include "parallel/session_words.h"
#include "render/trace/balance_trace.h"
#include "study/balance/replay.h"
#include "study/report/table.h"

namespace pprt {

// A policy over all runs of a file.
struct PolicyResult {
  BalanceMode policy = BalanceMode::kNone;
  std::vector<ReplayedRound> rounds = {};

  double mean_deviation() const;
  double mean_worst() const;
  int moved() const;         // tiles, in all rounds
  int repartitions() const;  // rounds with a new partition
  int differing() const;     // tiles with another owner than recorded, in all rounds
};

PolicyResult replay_all(const std::vector<BalanceTrace>& runs, BalanceMode policy);

// A row for each policy and round; a row for each policy.
Table rounds_table(const std::vector<PolicyResult>& results);
Table policies_table(const std::vector<PolicyResult>& results);

// Returns the table with its columns aligned, names first; a line each.
std::string aligned(const Table& table);

// Returns an object for each row, a line each; `record` is its kind. Empty cells are null.
std::string json_lines(const Table& table, const std::string& record);

}  // namespace pprt
