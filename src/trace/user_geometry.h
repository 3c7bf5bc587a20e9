// Spheres and cones as Embree user geometry: bounds and intersection callbacks.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/embree.h"
#include "trace/quadrics.h"

namespace pprt {

// The faces of a primitive that stop a ray; rays pass through the others.
enum class VisibleFaces : std::uint8_t { kBoth, kFront, kBack };

// Makes a geometry over the records. Every ray reads them: they must outlive the geometry and not move.
EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<SphereRecord>& records,
                                 VisibleFaces faces);
EmbreeGeometry new_user_geometry(const EmbreeDevice& device, const std::vector<ConeRecord>& records,
                                 VisibleFaces faces);

}  // namespace pprt
