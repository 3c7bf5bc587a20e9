// pprt-study paper: the paper's experiments repeated, as tables, plots and a page of findings.
#pragma once

#include <string>

#include "study/paper/paper_options.h"
#include "study/paper/runs.h"
#include "study/report/table.h"

namespace pprt {

// Writes into options.directory and reports progress on standard error. `command_line` goes into the
// provenance. Throws std::runtime_error where nothing can be written.
void study_paper(const PaperOptions& options, const std::string& command_line);

// Returns one row for each frame of each run.
Table frames_table(const PaperResults& results);

}  // namespace pprt
