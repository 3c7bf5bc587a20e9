// Objects that a script moves, as part of a scene.
#pragma once

#include "scene/animation/animation.h"
#include "scene/description/scene_description.h"

namespace pprt {

// Returns the movement that a script's keys describe, as a track in seconds. `times`: of the script's frames.
// Between keys the values follow the splines of motion_track.h. A turn about an axis is a number among them,
// so that it may be of any angle. Turns are exact at the frames' times. Before the first key and after the
// last one all stand still.
MotionTrack track_of(const ObjectMotion& object, const FrameTimes& times);

// Adds the objects of another scene under a node that the track called `name` moves. Its view, background,
// sky and lights do not count.
void add_moving(SceneDescription& scene, const SceneDescription& other, const std::string& name);

}  // namespace pprt
