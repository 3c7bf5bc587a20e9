// How large a scene is, and where its objects are at all times.
#pragma once

#include "base/vector.h"
#include "scene/description/scene_description.h"
#include "trace/geometry/normalisation.h"
#include "trace/geometry/numerics.h"

namespace pprt {

// What the compiled space is made from. Usually both boxes are the same: that of all objects at all times.
struct SceneExtent {
  Box3d measured;  // in scene space, of what the scale follows; empty: there is nothing
  Box3d shown;     // of all that is in Embree's reach, and of all that rests
  Normalisation normalisation;
};

// Measures a scene by what lies together in it. One object far away would else take the digits of all that
// are seen here. It has coordinates above 1 in the compiled space.
SceneExtent measure(const SceneDescription& scene);

inline bool is_finite(const Box3d& box) {
  return is_finite(Vec3d(box.max - box.min));
}

}  // namespace pprt
