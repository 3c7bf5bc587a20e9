// A script as it was written, each value with its place, and its interpretation as an Animation.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "parser/anim/anim_problems.h"
#include "parser/anim/anim_value.h"
#include "scene/animation/animation.h"

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
  // An object has these, and tension, continuity and bias.
  kTranslate,
  kRotate,
  kScale,
  kVisible,
  // A sun has from and color, a sky up, horizon and zenith.
  kColor,
  kHorizon,
  kZenith,
  kFieldCount
};

// The keywords of the fields, in the order of Field.
inline constexpr std::array<std::string_view, kFieldCount> kFieldWords = {
    "from",     "at",        "up",     "angle", "tension", "continuity", "bias",    "ease_in",
    "ease_out", "translate", "rotate", "scale", "visible", "color",      "horizon", "zenith"};

// What has fields.
enum class FieldOwner { kCamera, kObject, kSun, kSky };

constexpr bool is_of(FieldOwner owner, Field field) {
  switch (owner) {
    case FieldOwner::kCamera:
      return field < kTranslate;
    case FieldOwner::kObject:
      return (field >= kTranslate && field <= kVisible) || field == kTension || field == kContinuity ||
             field == kBias;
    case FieldOwner::kSun:
      return field == kFrom || field == kColor;
    case FieldOwner::kSky:
      return field == kUp || field == kHorizon || field == kZenith;
  }
  return false;
}

// A key, hold or cut statement.
struct WrittenKey {
  enum class Kind { kKey, kHold, kCut };
  Kind kind = Kind::kKey;
  const char* place = nullptr;  // of the keyword
  Value when;
  bool in_seconds = false;
  std::array<std::optional<Value>, kFieldCount> fields;
};

struct WrittenObject {
  std::string name;
  const char* place = nullptr;  // of the name
  std::vector<WrittenKey> keys;
};

// A script after parsing, before its values are checked.
struct WrittenScript {
  bool has_animation = false;
  bool has_camera = false;
  std::optional<std::string> scene;
  const char* scene_place = nullptr;  // of the keyword, if there is a scene
  std::optional<Value> frames, fps, resolution;
  std::optional<SplineKind> spline;
  std::vector<WrittenKey> keys;  // of the camera
  std::vector<WrittenObject> objects;
  std::vector<WrittenKey> suns;  // without a time
  std::optional<WrittenKey> sky;
};

// Checks every value and copies omitted camera fields from key to key. A value in error is reported and left
// out.
Animation interpret(const WrittenScript& script, std::string_view file_name, Problems& problems);

// The same for the keys of an object; `animation` has its rate already.
ObjectMotion interpret_object(const WrittenObject& object, const Animation& animation, bool fps_given,
                              Problems& problems);

// The same for the suns and the sky.
Daylight interpret_daylight(const WrittenScript& script, Problems& problems);

// Returns a value as a number, if it is one; reports a vector. `what` names it in the message.
std::optional<double> number(const Value& value, std::string_view what, Problems& problems);

// Returns the frame of a key, converted from seconds where needed; reports what is none.
std::optional<double> frame_of(const WrittenKey& written, const Animation& animation, bool fps_given,
                               Problems& problems);

// Reports a key that does not come after the one before. `before`: null for the first one.
bool is_in_order(double frame, const WrittenKey& written, const double* before, SourceLocation before_at,
                 Problems& problems);

}  // namespace pprt::anim
