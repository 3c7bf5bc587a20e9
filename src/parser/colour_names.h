// The X11 colour names, which MTV and programs after it accept in place of r g b.
#pragma once

#include <optional>
#include <string_view>

#include "scene/scene_description.h"

namespace pprt {

// The colour of a name of X11's rgb.txt, in any case and written without blanks ("LightSteelBlue", "grey42");
// empty for other names. Values are rgb.txt's, divided by 255.
std::optional<Rgb> color_by_name(std::string_view name);

}  // namespace pprt
