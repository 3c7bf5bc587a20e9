// What the frames of a run will show, found by some rays before anything is written: a run that would end
// well with empty pictures does not begin.
#pragma once

#include <string>

#include "render/render_plan.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Judges all frames of the script together, for one of them may well look at the sky: at first by 16 x 16
// rays a frame, which is enough nearly always, at last by a ray through the middle of every pixel, but no
// more than some four million in all. Throws InputError with the reason when no frame shows anything that
// stands out from the background. Returns a warning when every frame shows one colour throughout, and when
// there is no light; otherwise "".
std::string check_outlook(const RenderPlan& plan, const CompiledScene& scene);

}  // namespace pprt
