// Series of frames, rendered on virtual ranks: threads of this process. All experiments with more than one
// frame use them.
#pragma once

#include <functional>
#include <vector>

#include "parallel/master.h"
#include "parallel/session_words.h"
#include "scene/animation.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Returns the first `count` frames of an animation, with its camera cuts. Pictures have size x size pixels.
std::vector<FrameRequest> frames_of(const CompiledScene& scene, const Animation& animation, int count,
                                    View base, int size);

// Renders the frames on `ranks` ranks and passes each to the sink, in order. Throws what a rank throws.
void render_series(const CompiledScene& scene, const std::vector<FrameRequest>& frames, int ranks,
                   const SessionSettings& settings, const FrameSink& sink);

// Samples in a frame's picture, all ranks together.
double samples_in(const FinishedFrame& frame);

// Calls task(0) to task(count - 1), as many at a time as the host has cores. Rethrows a task's exception;
// tasks not begun by then are not called.
void run_concurrently(std::size_t count, const std::function<void(std::size_t)>& task);

}  // namespace pprt
