// What can be judged from the options alone.
#pragma once

#include "render/options/render_options.h"

namespace pprt {

// Throws UsageError with the first contradiction.
void check_usage(const RenderOptions& options);

// Whether something is asked for that only the triangulation knows.
bool needs_triangulation(const SessionSettings& method, WeightRule weights);

}  // namespace pprt
