// The animation script language (.anim, see pprt-anim(5)): text to the values of scene/animation.h.
#pragma once

#include <string>
#include <string_view>

#include "scene/animation.h"

namespace pprt {

struct ParsedAnimation {
  Animation animation;
  std::string warnings;  // formatted as file:line:column, line, caret; empty when there are none
};

// Reads a whole script. Throws InputError with every problem of the text: file:line:column, the line, a
// caret. What can be judged only with the scene's own view at hand is left to check_cameras
// (scene/animation.h).
ParsedAnimation parse_animation(std::string_view text, std::string_view file_name);

// The same for a file; one that cannot be read or is longer than any script is an InputError as well.
ParsedAnimation read_animation(const std::string& path);

}  // namespace pprt
