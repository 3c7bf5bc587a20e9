// The files of a run, checked before the first ray.
#pragma once

#include <set>
#include <string>

#include "render/plan/render_plan.h"

namespace pprt {

// Changes nothing. Throws UsageError when two outputs are the same file, or an output is a file that was read
// (base/file_table.h). Throws it when a file exists that may neither be replaced nor gone on with. Throws it
// when a reference does not exist. Throws std::runtime_error when a file cannot be written, or when a film is
// wanted and there is no ffmpeg.
void check_files(const RenderPlan& plan);

// Returns the names of the frames' files that an existing manifest must forget, because they are written
// anew.
std::set<std::string> rewritten_files(const RenderPlan& plan);

}  // namespace pprt
