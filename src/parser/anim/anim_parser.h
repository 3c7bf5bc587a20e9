// Reads the animation script language (.anim, see pprt-anim(5)) into the values of
// scene/animation/animation.h.
#pragma once

#include <string>
#include <string_view>

#include "scene/animation/animation.h"

namespace pprt {

// An animation and the warnings of its reading.
struct ParsedAnimation {
  Animation animation;
  std::string warnings;  // each as file:line:column, line, caret; empty when there are none
};

// Reads a script from memory; `file_name` is for messages. Throws InputError with every problem of the text,
// each with file:line:column, the line and a caret. Problems that depend on the scene's view are left to
// check_cameras (scene/animation/animation.h).
ParsedAnimation parse_animation(std::string_view text, std::string_view file_name);

// Reads a script from a file; "-" is standard input. Throws InputError also for a file that cannot be read or
// is longer than 16 MiB.
ParsedAnimation read_animation(const std::string& path);

}  // namespace pprt
