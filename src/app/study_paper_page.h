// The paper's experiments as tables, plots and a page.
#pragma once

#include "app/study_output.h"
#include "app/study_paper_runs.h"

namespace pprt {

// Every frame of every run, a row each.
Table frames_table(const PaperResults& results);

void write_paper(const PaperResults& results, const PaperOptions& options, StudyOutput& output);

}  // namespace pprt
