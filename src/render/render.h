// pprt-render: from options to numbered frames.
#pragma once

#include <span>
#include <string>

#include "render/options/render_options.h"

namespace pprt {

// Renders what the options ask for; they must have passed check_usage(). Starts itself again under mpirun,
// with the same words of the command line, when more than one rank is wanted and no launcher has started it.
// Returns the exit code: 0, or 128 + signal when a signal ended the run early. Throws what run_guarded()
// understands.
int render(const RenderOptions& options, std::span<const std::string> words);

}  // namespace pprt
