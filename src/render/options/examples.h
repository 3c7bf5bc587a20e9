// Commands to begin with.
#pragma once

#include <string>

namespace pprt {

// Returns what `pprt-render` says when it is called without a word.
std::string first_steps();

// Returns commands that can be typed as they stand, each after a comment. Scenes are those of the sources in
// the current folder, or else the installed ones.
std::string examples();

}  // namespace pprt
