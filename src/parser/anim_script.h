// A script as it was written, each value with its place, and its interpretation as an Animation.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "parser/anim_problems.h"
#include "parser/anim_value.h"
#include "scene/animation.h"

namespace pprt::anim {

// Fields of a key.
enum Field : std::size_t {
  kFrom,
  kAt,
  kUp,
  kAngle,
  kTension,
  kContinuity,
  kBias,
  kEaseIn,
  kEaseOut,
  kFieldCount
};

// The keywords of the fields, in the order of Field.
inline constexpr std::array<std::string_view, kFieldCount> kFieldWords = {
    "from", "at", "up", "angle", "tension", "continuity", "bias", "ease_in", "ease_out"};

// A key, hold or cut statement.
struct WrittenKey {
  enum class Kind { kKey, kHold, kCut };
  Kind kind = Kind::kKey;
  const char* place = nullptr;  // of the keyword
  Value when;
  bool in_seconds = false;
  std::array<std::optional<Value>, kFieldCount> fields;
};

// A script after parsing, before its values are checked.
struct WrittenScript {
  bool has_animation = false;
  bool has_camera = false;
  std::optional<std::string> scene;
  const char* scene_place = nullptr;  // of the keyword, if there is a scene
  std::optional<Value> frames, fps, resolution;
  std::optional<SplineKind> spline;
  std::vector<WrittenKey> keys;
};

// Checks every value and copies omitted camera fields from key to key. A value in error is reported and left
// out.
Animation interpret(const WrittenScript& script, std::string_view file_name, Problems& problems);

}  // namespace pprt::anim
