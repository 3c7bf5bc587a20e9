// Writing a scene for POV-Ray 3.7, so that its picture can be laid over ours.
#pragma once

#include <cstddef>
#include <iosfwd>

#include "scene/scene_description.h"

namespace pprt {

// What POV-Ray's language has no words for, or what is nothing to see.
struct PovLosses {
  std::size_t one_sided = 0;   // spheres and cones of which only the inside is seen: written two-sided
  std::size_t degenerate = 0;  // primitives of no extent: left out, as in our pictures
};

// Writes the whole scene as text that POV-Ray renders with the same image plane and, as far as its model
// allows, the same shading; pprt-convert(1) tells the differences. Spheres, cones and cylinders stay what
// they are; polygons and patches become meshes over the triangles that are traced here, too. All numbers must
// be finite. Throws InputError when the scene has no view or a degenerate one. A failing stream is left
// failed.
PovLosses write_pov(const SceneDescription& scene, std::ostream& out);

}  // namespace pprt
