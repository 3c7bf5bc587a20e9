// pprt-study paper: the paper's experiments run anew, as tables, plots and a page of findings.
#pragma once

#include <string>

#include "study/paper/runs.h"

namespace pprt {

// Writes into options.directory, telling on standard error how far it is. `command_line` is told as it is.
// Throws UsageError for a machine that there is not, std::runtime_error where nothing can be written.
void study_paper(const PaperOptions& options, const std::string& command_line);

}  // namespace pprt
