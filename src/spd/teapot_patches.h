// Newell's teapot as 32 bicubic Bezier patches. Private to src/spd.
#pragma once

#include <array>
#include <vector>

#include "base/vector.h"

namespace pprt::spd {

using BezierPatch = std::array<std::array<Vec3d, 4>, 4>;  // control points [along s][along t]

// Returns rim, body, handle, spout, lid and bottom. z is up, the board at z = 0. dP/dt x dP/ds points
// outwards.
std::vector<BezierPatch> teapot_patches();

}  // namespace pprt::spd
