// The paper's experiments as tables, plots and a page.
#pragma once

#include "study/output.h"
#include "study/paper/runs.h"

namespace pprt {

// Every frame of every run, a row each.
Table frames_table(const PaperResults& results);

void write_paper(const PaperResults& results, const PaperOptions& options, StudyOutput& output);

}  // namespace pprt
