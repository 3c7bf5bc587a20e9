// Writes animations as scripts (pprt-anim(5)).
#pragma once

#include <string>

#include "scene/animation/animation.h"

namespace pprt {

// Returns a script that reads back as the same animation, each number to the bit. Where a key leaves a field
// to the scene, so does the script. A scene's name that no script can hold, with quotes or line breaks, is
// left out.
std::string anim_script(const Animation& animation);

}  // namespace pprt
