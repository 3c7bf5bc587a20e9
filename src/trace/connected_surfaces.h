// Which polygons and triangles together are one surface: such as meet at a corner with the same normal there
// and have one material.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trace/scene_impl.h"

namespace pprt {

// Returns a surface's number for each primitive from 0 to `primitives`: that of its first primitive. A
// primitive that is no polygon, and one whose shape changes, is a surface of its own. O(n) in the mean.
std::vector<std::uint32_t> connected_surfaces(std::span<const ScenePart> parts, std::uint32_t primitives);

}  // namespace pprt
