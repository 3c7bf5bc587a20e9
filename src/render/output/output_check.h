// The files of a run, checked before the first ray.
#pragma once

#include <set>
#include <string>

#include "render/plan/render_plan.h"

namespace pprt {

// Throws UsageError when two outputs, or an output and an input, are the same file; when a file exists that
// may not be replaced; when a reference does not exist. Throws std::runtime_error when a file cannot be
// written, or when a film is wanted and there is no ffmpeg. Changes nothing.
//
// Two names mean the same file if their directories do, and also if both exist and are one file by device and
// inode: symbolic and hard links are seen. Frames among themselves are told apart by name alone, because
// each is a new file that takes its name.
void check_files(const RenderPlan& plan);

// Returns the names of the frames' files that an existing manifest must forget, because they are written
// anew.
std::set<std::string> rewritten_files(const RenderPlan& plan);

}  // namespace pprt
