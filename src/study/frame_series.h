// Series of frames, rendered on virtual ranks: threads of this process. All experiments with more than one
// frame use them.
#pragma once

#include <functional>
#include <vector>

#include "parallel/master/master.h"
#include "parallel/settings/session_words.h"
#include "scene/animation/animation.h"
#include "study/reference.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Returns the camera of a view whose picture has size x size pixels.
Camera square_camera(const CompiledScene& scene, View view, int size);

// Returns the first `count` frames of an animation, with its camera cuts. From one to the next the camera
// goes `speed` frames of the script on. Pictures have size x size pixels.
std::vector<FrameRequest> frames_of(const CompiledScene& scene, const Animation& animation, int count,
                                    const View& base, int size, double speed = 1);

// Renders the frames on `ranks` ranks and passes each to the sink, in order. Throws what a rank throws.
void render_series(const CompiledScene& scene, const std::vector<FrameRequest>& frames, int ranks,
                   const SessionSettings& settings, const FrameSink& sink);

// Returns the work units that a rank does per second of CPU time on this machine and scene.
double measured_units_per_second(const Subject& subject, SamplerChoice sampler);

// Asks for the work of a frame that makes a number of samples, all ranks together.
struct WorkQuestion {
  double samples = 0;
  double guess_per_sample = 1;  // units
  double pixel_units = 0;       // for the pixels, which do not depend on the samples
  int corrections = 1;          // few: the cost of a sample changes little with their number
};

// Returns that work in units. `samples_made` renders and returns the number of samples that so much work
// makes.
double work_for_samples(const WorkQuestion& question,
                        const std::function<double(double units)>& samples_made);

// Calls task(0) to task(count - 1), as many at a time as the host has cores. Rethrows a task's exception;
// tasks not begun by then are not called.
void run_concurrently(std::size_t count, const std::function<void(std::size_t)>& task);

}  // namespace pprt
