// An independent brute-force tracer: every ray against every primitive, in long double, straight from the
// scene description. No BVH, no compiled space, no offsets; it shares no code with src/trace.
#pragma once

#include <vector>

#include "scene/description/scene_description.h"

namespace pprt::test {

// Renders the scene's own view at size x size pixels, one ray through the centre of each: linear colours, row
// by row from the top. Surfaces are two-sided unless a radius is negative, ray trees at most 5 deep. Patches
// must be triangles.
std::vector<Rgb> oracle_picture(const SceneDescription& scene, int size);

}  // namespace pprt::test
