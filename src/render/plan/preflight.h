// A few rays before a run: one that would end well with empty pictures does not begin.
#pragma once

#include <string>

#include "render/plan/render_plan.h"
#include "trace/compiled_scene.h"

namespace pprt {

// Judges all frames of the script together, as one of them may look at the sky; of a long script those of the
// plan's script_frames. Then it warns where it would refuse. Traces 16 x 16 rays a frame,
// which nearly always is enough. Otherwise traces a ray through the middle of every pixel, but at most about
// four million in all.
//
// Throws InputError with the reason when no frame shows anything that differs from the background. Returns
// warnings, each a line: objects are repeated; the scene has no light; every frame shows one colour
// throughout; glass is turned inside out.
std::string preflight(const RenderPlan& plan, const CompiledScene& scene);

// Throws InputError with the first frame whose eye is too far away to resolve the scene (kFarthestEye).
void require_eyes_in_reach(const RenderPlan& plan, const CompiledScene& scene);

}  // namespace pprt
