// Tables of the figures of recorded runs.
#pragma once

#include <string>
#include <vector>

#include "parallel/settings/session_words.h"
#include "study/balance/figures.h"
#include "study/report/table.h"

namespace pprt {

// The figures of one trace, over all its runs.
struct TraceResult {
  std::string name;  // of the file, without folder and extension
  BalanceMode balance = BalanceMode::kNone;
  std::vector<FrameFigures> frames = {};

  double mean_deviation() const;
  double mean_worst() const;
  int moved() const;         // tiles, in all frames
  int given() const;         // likewise
  int repartitions() const;  // frames with a new partition
};

// A row for each trace and frame; a row for each trace.
Table frames_table(const std::vector<TraceResult>& results);
Table traces_table(const std::vector<TraceResult>& results);

// A row for each frame, with the deviation of each trace. A trace that lacks the frame has an empty cell.
Table deviations_table(const std::vector<TraceResult>& results);

// Returns the table with its columns aligned, names first; a line each.
std::string aligned(const Table& table);

// Returns an object for each row, a line each; `record` is its kind. Empty cells are null.
std::string json_lines(const Table& table, const std::string& record);

}  // namespace pprt
