// Pictures of the paper's figures 1, 2 and 4: frames, and how they came about.
#pragma once

#include "study/paper/runs.h"

namespace pprt {

// Adds the pictures to be shown of this frame of the run, if any. `run` must have asked for its samples.
void add_pictures(const PaperOptions& options, const PaperRun& run, const FinishedFrame& frame,
                  PaperResults& results);

}  // namespace pprt
