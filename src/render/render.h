// pprt-render: from a command line to numbered frames.
#pragma once

#include "render/render_options.h"

namespace pprt {

// Renders what the options ask for, under mpirun when they ask for more than one rank and it does not run
// yet. Returns the exit code: 0, or 128 + signal when a signal ended the run early. `config` is the effective
// options as a file, for --write-config. Throws what run_guarded() understands.
int render(const RenderOptions& options, const std::string& config, int argc, char** argv);

}  // namespace pprt
