// Spheres and cones as Embree user geometry: bounds and intersection callbacks.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/geometry/embree.h"
#include "trace/geometry/quadrics.h"

namespace pprt {

// The faces of a primitive that stop a ray; rays pass through the others.
enum class VisibleFaces : std::uint8_t { kBoth, kFront, kBack };

// The rays that meet a geometry: those of a scene have unit length, those of an instance any.
enum class RayLength : std::uint8_t { kUnit, kAny };

// Makes a geometry over the records. Every ray reads them: they must outlive the geometry and not move.
EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<SphereRecord>& records,
                                 VisibleFaces faces, RayLength rays);
EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<ConeRecord>& records,
                                 VisibleFaces faces, RayLength rays);

}  // namespace pprt
