// Movement by keys with straight lines between them, as glTF has it, as splines and back.
#pragma once

#include <functional>
#include <vector>

#include "scene/movement/motion_track.h"

namespace pprt {

// Turn keys, at least one and in order of time, into those of a curve that passes from each to the next at an
// even speed. Rotations take the short way (slerp). Two keys are added that only shape the curve. The shapes
// follow from the tangents of Kochanek and Bartels: both must equal the segment's own change.
void make_straight(std::vector<VectorKey>& keys);
void make_straight(std::vector<RotationKey>& keys);

// Returns the times at which a curve of a track has keys, and those of its visibility.
std::vector<double> key_times(const MotionTrack& track);

// Returns ascending times: those given, and as many between as are needed for straight lines from one to the
// next. These then lie within 1/4,000 of the movement's extent, and within 0.02 degrees. A jump gets a time
// shortly before it. `times`: at least one, in any order, each finite.
std::vector<double> straight_times(std::vector<double> times,
                                   const std::function<TrackValues(double)>& values_at);

// Returns a track with keys at these times, ascending and at least one, and straight lines between them. It
// is always visible.
MotionTrack straight_track(const std::vector<double>& times,
                           const std::function<TrackValues(double)>& values_at);

}  // namespace pprt
