// The movement of a camera in the world.
#pragma once

#include <functional>
#include <vector>

#include "scene/description/scene_description.h"
#include "scene/movement/motion_track.h"

namespace pprt {

// Returns a track for a camera that moves as `view_at` tells, with straight lines between as many keys as it
// needs. `times`: those between which it moves smoothly, at least one.
MotionTrack camera_track(std::vector<double> times, const std::function<View(double)>& view_at);

}  // namespace pprt
