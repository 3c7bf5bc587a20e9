// A process's part of a run, with all of its ranks.
#pragma once

#include <functional>
#include <optional>

#include "cli/process/log.h"
#include "render/plan/render_plan.h"
#include "render/records/progress.h"

namespace pprt {

// Makes the plan: in the first process, once, while the others wait for their job.
using PlanMaker = std::function<RenderPlan()>;

// Runs as one of the processes that an MPI launcher has started, or else alone. `threads`: ranks of the
// process; empty: as many as it has cores. Returns the exit code. Throws what run_guarded() understands.
int run_process(const PlanMaker& make_plan, std::optional<int> threads, LogLevel log,
                ProgressReporter& progress);

}  // namespace pprt
