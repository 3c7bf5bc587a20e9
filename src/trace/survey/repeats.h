// Finds primitives that repeat an earlier one exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/description/scene_description.h"

namespace pprt {

// Primitives that equal an earlier one in kind, geometry and material. Indices are places in
// SceneDescription::order.
struct Repeats {
  std::vector<bool> repeated;  // by place; empty: none
  std::size_t count = 0;
  std::uint32_t first = 0;  // if count > 0
};

// Finds them in linear time. Leaving them out changes no ray's colour: a ray meets both copies at the same
// parameter, computed from the same numbers, and the surface there is the same. Copies with different
// materials count as different, because rounding chooses the one that is seen.
//
// A million equal spheres have one box, so that every ray into it tries each of them.
Repeats find_repeats(const SceneDescription& scene);

}  // namespace pprt
