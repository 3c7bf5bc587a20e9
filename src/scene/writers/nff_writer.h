// Writes a scene as NFF, in the layout of Haines' Standard Procedural Databases.
#pragma once

#include <iosfwd>

#include "scene/description/scene_description.h"
#include "scene/writers/text_output.h"

namespace pprt {

// Writes background, view, lights, then the objects in file order. A material is written before the first
// object and wherever it changes. What the scene does not give is not written, nor are unused materials. All
// numbers must be finite. A failing stream is left failed, as by operator<<.
void write_nff(const SceneDescription& scene, std::ostream& out,
               NumberFormat format = NumberFormat::kShortest);

}  // namespace pprt
