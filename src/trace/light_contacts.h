// Lights that lie on surfaces: a lamp in the plane of a ceiling, a bulb's light on its glass.
//
// A shadow ray to such a light ends on the surface, and rounding decides whether it meets it. So the surface
// is looked for once, when the scene is compiled. A hit on it near the light hides nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vector.h"

namespace pprt {

struct ScenePart;

// A primitive on which a light lies.
struct LightContact {
  std::uint32_t part = 0;       // index of the ScenePart, Embree's geometry number
  std::uint32_t primitive = 0;  // Embree's primitive number in it
  float reach = 0;  // a hit hides the light if it is farther than this before it; infinite on triangles
};

// Returns the primitives that hold the light at `position`, within the error of a shadow ray's end. All is in
// the compiled space; `radius` is that of a sphere about the origin that contains the scene.
std::vector<LightContact> contacts_of_light(const Vec3d& position, std::span<const ScenePart> parts,
                                            double radius);

}  // namespace pprt
