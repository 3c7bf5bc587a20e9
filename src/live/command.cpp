#include "live/command.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "scene/animation/animation.h"

namespace pprt {
namespace {

using Json = nlohmann::json;

constexpr double kMostCoordinate = 1e15;

const Json& member(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) throw CommandError(fmt::format("'{}' is missing", name));
  return *found;
}

double number(const Json& value, const char* name, double least, double most) {
  const double v = value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!(v >= least && v <= most))
    throw CommandError(fmt::format("'{}' is not a number from {:.10g} to {:.10g}", name, least, most));
  return v;
}

double number_in(const Json& object, const char* name, double least, double most) {
  return number(member(object, name), name, least, most);
}

int whole_in(const Json& object, const char* name, int least, int most) {
  const double v = number_in(object, name, least, most);
  if (v != std::floor(v)) throw CommandError(fmt::format("'{}' is not a whole number", name));
  return static_cast<int>(v);
}

Vec3d point_in(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_array() || value.size() != 3)
    throw CommandError(fmt::format("'{}' has not three numbers", name));
  const auto at = [&](std::size_t i) { return number(value[i], name, -kMostCoordinate, kMostCoordinate); };
  return {at(0), at(1), at(2)};
}

View camera_in(const Json& object) {
  View view;
  view.from = point_in(object, "from");
  view.at = point_in(object, "at");
  view.up = point_in(object, "up");
  view.angle_degrees = number_in(object, "angle", 0.1, 170);
  const std::string_view defect = camera_defect(view.from, view.at, view.up);
  if (!defect.empty()) throw CommandError(std::string(defect));
  return view;
}

LookFrom look_from(const Json& object) {
  return {
      .number = static_cast<std::uint32_t>(whole_in(object, "number", 0, std::numeric_limits<int>::max())),
      .view = camera_in(object)};
}

int key_frame_in(const Json& object, const char* name) {
  return whole_in(object, name, 1, kLastKeyFrame);
}

SetKey set_key(const Json& object) {
  SetKey key{.frame = key_frame_in(object, "frame")};
  const auto view = object.find("view");
  if (view == object.end()) return key;
  if (!view->is_object()) throw CommandError("'view' is no camera");
  key.view = camera_in(*view);
  return key;
}

template <class Value>
Value word_in(const Json& object, const char* name) {
  const Json& value = member(object, name);
  const std::optional<Value> found =
      value.is_string() ? find_word<Value>(value.get_ref<const std::string&>()) : std::nullopt;
  if (!found) throw CommandError(fmt::format("'{}' has no such value", name));
  return *found;
}

bool flag_in(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_boolean()) throw CommandError(fmt::format("'{}' is neither true nor false", name));
  return value.get<bool>();
}

Json object_of(std::string_view text) {
  Json object = Json::parse(text, nullptr, false);
  if (!object.is_object()) throw CommandError("a message is no JSON object");
  return object;
}

}  // namespace

LiveCommand parse_command(std::string_view text) {
  const Json object = object_of(text);
  const Json& what = member(object, "do");
  const std::string word = what.is_string() ? what.get<std::string>() : std::string();
  constexpr int kMany = std::numeric_limits<int>::max();
  if (word == "take") return TakeCamera{};
  if (word == "give") return GiveCamera{};
  if (word == "pass") return PassCamera{whole_in(object, "to", 1, kMany)};
  if (word == "look") return look_from(object);
  if (word == "play") return PlayScript{true};
  if (word == "pause") return PlayScript{false};
  if (word == "step") return StepScript{whole_in(object, "by", -kMany, kMany)};
  if (word == "seek") return SeekScript{whole_in(object, "frame", 0, kMany)};
  if (word == "rate") return SetRate{number_in(object, "fps", kSlowestRate, kFastestRate)};
  if (word == "size") {
    return SetSize{whole_in(object, "width", 1, kLongestLiveSide),
                   whole_in(object, "height", 1, kLongestLiveSide)};
  }
  if (word == "overlay") return ShowOverlay{word_in<Overlay>(object, "name")};
  if (word == "pivot") return FindPivot{number_in(object, "x", 0, 1), number_in(object, "y", 0, 1)};
  if (word == "key") return set_key(object);
  if (word == "drop") return DropKey{key_frame_in(object, "frame")};
  if (word == "move") return MoveKey{key_frame_in(object, "frame"), key_frame_in(object, "to")};
  if (word == "undo") return UndoKeys{};
  if (word == "redo") return RedoKeys{};
  if (word == "film") return PlayFilm{flag_in(object, "on")};
  if (word == "photo") return TakePhoto{word_in<PhotoFormat>(object, "format")};
  throw CommandError("there is no such command");
}

}  // namespace pprt
