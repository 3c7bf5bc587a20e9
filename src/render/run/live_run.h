// A run with a live view: frames without end, by the script or by somebody's hand.
#pragma once

#include <functional>

#include "parallel/master/master.h"
#include "render/output/frame_recorder.h"
#include "render/plan/render_plan.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Renders one sequence with all ranks. `is_enough`: see SessionEvents.
using RunSequence = std::function<void(const SessionSettings& settings, const CameraSource& source,
                                       const FrameSink& sink, const std::function<bool()>& is_enough)>;

// Serves the page of `plan.live` and renders what it asks for, one sequence after the other: each has its
// rate and size. Returns when a signal has asked for the end or a file cannot be written. A recorder gets
// each frame of the script when it is shown first. The run then ends once it has all and nobody has the
// camera.
//
// Throws std::runtime_error where the address cannot be had.
void run_live(const RenderPlan& plan, const CompiledScene& scene, int ranks, FrameRecorder* recorder,
              const RunSequence& run_sequence);

}  // namespace pprt
