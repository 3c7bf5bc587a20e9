// The camera's movement over one span between two keys, with the keys around it for the tangents.
// Decision and derivation: docs/decisions/0002-camera-interpolation.md.
#pragma once

#include <span>

#include "scene/animation.h"

namespace pprt {

// The camera at `frame` between keys[span] and keys[span + 1]. `keys` are resolved, proper cameras of one
// uncut stretch: the two, and where there are such the one before and the one after (nothing else is used).
CameraKey camera_between(std::span<const CameraKey> keys, std::size_t span, double frame, SplineKind spline);

// Share of the way covered after share `u` of the time, with the given shares of the time spent accelerating
// from rest and slowing down to rest: quadratic, linear, quadratic; speed is continuous and never negative.
double eased(double u, double ease_in, double ease_out);

// Whether both keys show the same picture: from, at, up and angle are equal.
bool same_camera(const CameraKey& a, const CameraKey& b);

}  // namespace pprt
