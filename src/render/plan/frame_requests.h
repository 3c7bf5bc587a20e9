// Which frames of a plan the ranks are asked for, and in which order.
#pragma once

#include <functional>
#include <vector>

#include "parallel/master/master.h"
#include "render/plan/render_plan.h"

namespace pprt {

// Whether an earlier run has finished the frame of this number.
using FinishedBefore = std::function<bool(int frame)>;

// Returns the frames that are missing. On the work clock the frames from which they follow are asked for
// again: pictures must equal those of an undisturbed run. The real time of a run never repeats itself, so
// that on the wall clock the missing frames are enough.
std::vector<FrameRequest> frame_requests(const RenderPlan& plan, const CompiledScene& scene, int ranks,
                                         const FinishedBefore& finished_before);

}  // namespace pprt
