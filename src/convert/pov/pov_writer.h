// Writing a scene for POV-Ray 3.7, whose picture then matches ours pixel by pixel.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>

#include "scene/description/scene_description.h"

namespace pprt {

// What could not be written.
struct PovLosses {
  std::size_t one_sided = 0;        // spheres and cones with only the inside visible: written two-sided
  std::size_t degenerate = 0;       // primitives of no extent: left out, as in our pictures
  std::size_t lost_highlights = 0;  // materials whose highlight becomes white: see PovMaterial
  std::size_t lost_ambient = 0;     // materials whose ambient light lacks a colour: see PovMaterial
};

// Writes the scene so that POV-Ray renders the same image plane and, as far as its model allows, the same
// shading; pprt-convert(1) lists the differences. Spheres, cones and cylinders stay exact. Polygons and
// patches become meshes of the triangles that are traced here too. Textures are named as pov_pictures() names
// them for `stem`; they have to lie beside the scene. Nothing may move (still_at()), and all numbers must be
// finite. Throws InputError when the scene has no view or a degenerate one. A failing stream is left failed.
PovLosses write_pov(const SceneDescription& scene, std::ostream& out, const std::string& stem = "scene");

}  // namespace pprt
