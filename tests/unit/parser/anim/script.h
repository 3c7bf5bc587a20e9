// Short ways to parse scripts, for the tests of this folder.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "parser/anim/anim_parser.h"

namespace pprt {

inline Animation parsed(std::string_view text) {
  return parse_animation(text, "a.anim").animation;
}

// A script of one camera.
inline Animation camera(const std::string& body) {
  return parsed("animation { fps 10 frames 100 camera { " + body + " } }");
}

// The value of an expression, by way of a position.
inline double value(const std::string& expression) {
  return camera("key 1 { from <" + expression + ", 0, 0> at <0, 0, 1> up <0, 1, 0> }").keys.at(0).from.x;
}

// The whole report of a script that is rejected; empty when it is not.
inline std::string script_report(std::string_view text) {
  try {
    parse_animation(text, "a.anim");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

inline const char* const kExample = R"(// The camera goes half round the tree, then jumps back.
#declare R = 4.6;
animation {
  scene "spd:tree"          // or a file, relative to the script
  frames 40  fps 4  resolution <256, 256>
  camera {
    spline tcb
    key 1  { from <R, 0.4, 2> at <0, 0, 1.5> up <0, 0, 1> angle 45 }
    hold 10                                           /* still until frame 10 */
    key 20 { from <-R*cos(30), R*sin(30), 2> at <0, 0, 1.5> angle 30 }  # the rest stays as it was
    cut 31 { from <R, 0.4, 2> at <0, 0, 1.5> angle 45 tension 0.5 continuity -0.5 bias 1 ease_in .25 ease_out .5 }
  }
}
)";

}  // namespace pprt
