// Spheres and cones as Embree user geometry: bounds, and the intersection callbacks.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/embree.h"
#include "trace/quadrics.h"

namespace pprt {

// Which faces of a primitive stop a ray.
enum class Sides : std::uint8_t { kBoth, kFront, kBack };

// A geometry over the records, which it reads on every ray: they must outlive it and stay where they are.
EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<SphereRecord>& records,
                                 Sides sides);
EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<ConeRecord>& records,
                                 Sides sides);

}  // namespace pprt
