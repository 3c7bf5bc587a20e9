// The camera's movement over one segment between two keys. The neighbouring keys determine the tangents.
// Derivation: docs/decisions/0002-camera-interpolation.md.
#pragma once

#include <span>

#include "scene/animation/animation.h"

namespace pprt {

// Returns the camera at `frame` between keys[first] and keys[first + 1]. `keys` are two to four valid cameras
// without a cut between them: these two, and their neighbours where they exist.
CameraKey camera_between(std::span<const CameraKey> keys, std::size_t first, double frame, SplineKind spline);

// Maps share `u` of the time to the share of the way, both in [0, 1]. The camera accelerates over `ease_in`
// of the time, moves evenly, and slows down over `ease_out`. The speed is continuous and never negative.
double eased(double u, double ease_in, double ease_out);

// Rotates v about a unit axis by an angle in radians, counter-clockwise seen from the axis' tip (Rodrigues).
Vec3d rotated(const Vec3d& v, const Vec3d& axis, double angle);

// Returns whether both keys show the same picture: equal from, at, up and angle.
bool same_camera(const CameraKey& a, const CameraKey& b);

}  // namespace pprt
