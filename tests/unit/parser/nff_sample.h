// A small scene with each of NFF's entities, and short ways to read one.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "parser/nff_parser.h"

namespace pprt {

constexpr std::string_view kSample =
    "b 0.078 0.361 0.753\n"
    "v\n"
    "from 2.1 1.3 1.7\n"
    "at 0 0 0\n"
    "up 0 0 1\n"
    "angle 45\n"
    "hither 0.01\n"
    "resolution 512 256\n"
    "l 4 3 2\n"
    "l 1 -4 4 1 0.5 0.25\n"
    "f 1 0.75 0.33 0.8 0 100000 0 1\n"
    "p 4\n"
    "12 12 -0.5\n"
    "-12 12 -0.5\n"
    "-12 -12 -0.5\n"
    "12 -12 -0.5\n"
    "f 1 0.9 0.7 0.5 0.5 3.0827 0.25 1.5\n"
    "s 0 0 0 0.5\n"
    "c 0 0 0 1 0 0 1 0.5\n"
    "f 1 0.75 0.33 0.8 0 100000 0 1\n"
    "pp 3\n"
    "0 0 0 0 0 1\n"
    "1 0 0 0 0 2\n"
    "0 1 0 0 1 1\n";

inline NffOptions strict() {
  NffOptions options;
  options.strict = true;
  return options;
}

// The report on a text that is rejected; "" when it is accepted.
inline std::string report(std::string_view text, const NffOptions& options = {}) {
  try {
    parse_nff(text, "t.nff", options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

inline std::string warnings(std::string_view text) {
  return parse_nff(text, "t.nff").warnings;
}
inline SceneDescription scene(std::string_view text) {
  return parse_nff(text, "t.nff").scene;
}

}  // namespace pprt
