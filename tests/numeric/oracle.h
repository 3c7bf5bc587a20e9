// A second opinion on pictures: every ray against every primitive, in long double, straight from the scene
// description. No hierarchy, no compiled space, no offsets; shares no code with src/trace.
#pragma once

#include <vector>

#include "scene/scene_description.h"

namespace pprt::test {

// The scene's own view at size x size pixels, a ray through the middle of each: linear colours, row by row
// from the top. Surfaces are two-sided (but for negative radii), ray trees at most 5 deep. Patches must be
// triangles.
std::vector<Rgb> oracle_picture(const SceneDescription& scene, int size);

}  // namespace pprt::test
