// Writes a scene as AFF, the Animated File Format of BART (Lext, Assarsson and Moller 2000), with its
// movement.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "scene/description/scene_description.h"

namespace pprt {

// Writes one file: background, view, ambient light, times, movements, lights, then the objects in file order.
// Objects of one node after another share its transform, triangles of one mesh its lists.
//
// Lights of a scene without ambient light, one in NFF, are written as bright as NFF's rules make them. A
// node's map that turns between two stretches becomes two transforms. Names of movements get '_' for what AFF
// does not allow. `texture_files`: the name of each texture's file, without a folder. Numbers read back as
// the same; all must be finite. A failing stream is left failed, as by operator<<.
void write_aff(const SceneDescription& scene, std::ostream& out,
               const std::vector<std::string>& texture_files = {});

}  // namespace pprt
