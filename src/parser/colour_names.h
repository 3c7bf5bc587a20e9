// The X11 colour names. MTV's ray tracer and its successors accept them in place of r g b.
#pragma once

#include <optional>
#include <string_view>

#include "scene/description/scene_description.h"

namespace pprt {

// Returns the colour of a name in X11's rgb.txt; empty for other names. Case does not matter, and names have
// no blanks ("LightSteelBlue", "grey42"). Values are those of rgb.txt divided by 255.
std::optional<Rgb> color_by_name(std::string_view name);

}  // namespace pprt
