// The pictures of the paper's figures 1, 2 and 4: frames, and how they came about.
#pragma once

#include <vector>

#include "study/paper/runs.h"

namespace pprt {

// What is shown of this frame of the run; of most frames nothing. `run` must have asked for its samples.
std::vector<Picture> pictures_of(const PaperOptions& options, const PaperRun& run,
                                 const FinishedFrame& frame);

}  // namespace pprt
