#include "parser/anim/anim_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/movement/movement_limits.h"

namespace pprt::anim {
namespace {

constexpr double kMostFps = 1000;
constexpr double kLargestSide = 16384;  // pixels

std::optional<int> whole_number(double value, double most) {
  if (value != std::trunc(value) || value < 1 || value > most) return std::nullopt;
  return static_cast<int>(value);
}

void interpret_frames(const Value& value, Animation& animation, Problems& problems) {
  const std::optional<double> frames = number(value, "frames", problems);
  if (!frames) return;
  if (const std::optional<int> whole = whole_number(*frames, kMostFrames)) {
    animation.frames = *whole;
  } else {
    problems.error(value.place,
                   fmt::format("'frames' is a whole number from 1 to {}, not {}", kMostFrames, *frames));
  }
}

void interpret_fps(const Value& value, Animation& animation, Problems& problems) {
  const std::optional<double> fps = number(value, "fps", problems);
  if (!fps) return;
  if (*fps >= kLeastFramesPerSecond && *fps <= kMostFps) {
    animation.fps = *fps;
  } else {
    problems.error(value.place,
                   fmt::format("'fps' is from {} to {}, not {}", kLeastFramesPerSecond, kMostFps, *fps));
  }
}

void interpret_resolution(const Value& value, Animation& animation, Problems& problems) {
  if (!value.known()) return;
  if (value.size != 2) {
    problems.error(value.place, "'resolution' is a vector of two: <width, height>");
    return;
  }
  animation.width = whole_number(value.c[0], kLargestSide);
  animation.height = whole_number(value.c[1], kLargestSide);
  if (!animation.width || !animation.height) {
    problems.error(value.place, fmt::format("'resolution' is of whole numbers from 1 to {}, not <{}, {}>",
                                            kLargestSide, value.c[0], value.c[1]));
  }
}

// Reads the keys in order and keeps the camera as it stands after each.
class KeyReader {
 public:
  KeyReader(Animation& animation, bool fps_given, Problems& problems)
      : animation_(animation), fps_given_(fps_given), problems_(problems) {}

  void read(const WrittenKey& written) {
    if (first_ && written.kind != WrittenKey::Kind::kKey) {
      problems_.error(written.place, written.kind == WrittenKey::Kind::kHold
                                         ? "nothing to hold: no key stands before this"
                                         : "nothing to cut from: no key stands before this");
      return;
    }
    const std::optional<double> frame = frame_of(written, animation_, fps_given_, problems_);
    begin_camera(written);
    read_fields(written);
    check_camera(written);
    first_ = false;
    const CameraKey* before = animation_.keys.empty() ? nullptr : &animation_.keys.back();
    if (!frame || !is_in_order(*frame, written, before ? &before->frame : nullptr,
                               before ? before->location : SourceLocation(), problems_))
      return;
    camera_.frame = *frame;
    animation_.keys.push_back(camera_);
  }

 private:
  // Starts from the camera of the key before; after a cut, from the scene's view.
  void begin_camera(const WrittenKey& written) {
    const bool hold = written.kind == WrittenKey::Kind::kHold;
    if (first_ || written.kind == WrittenKey::Kind::kCut) {
      camera_ = {};
      camera_.of_scene = {.from = true, .at = true, .up = true, .angle = true};
    }
    camera_.cut = written.kind == WrittenKey::Kind::kCut;
    camera_.hold = hold;
    camera_.location = problems_.location(written.place);
  }

  void read_fields(const WrittenKey& written) {
    read_vector(written, kFrom, camera_.from, camera_.of_scene.from);
    read_vector(written, kAt, camera_.at, camera_.of_scene.at);
    read_vector(written, kUp, camera_.up, camera_.of_scene.up);
    read_angle(written);
    read_number(written, kTension, -1, camera_.tension);
    read_number(written, kContinuity, -1, camera_.continuity);
    read_number(written, kBias, -1, camera_.bias);
    read_number(written, kEaseIn, 0, camera_.ease_in);
    read_number(written, kEaseOut, 0, camera_.ease_out);
    if (camera_.ease_in + camera_.ease_out > 1) {
      report_at(written, {kEaseOut, kEaseIn},
                fmt::format("'ease_in' and 'ease_out' share the way: {} and {} are more than 1",
                            camera_.ease_in, camera_.ease_out));
      camera_.ease_in = camera_.ease_out = 0;
    }
    for (const Field field : {kTension, kContinuity, kBias}) {
      if (animation_.spline != SplineKind::kTcb && written.fields[field]) {
        problems_.warning(written.fields[field]->place,
                          fmt::format("'{}' has no effect: the spline is not tcb", kFieldWords[field]));
      }
    }
  }

  void read_vector(const WrittenKey& written, Field field, Vec3d& into, bool& of_scene) {
    if (!written.fields[field]) return;
    const Value& value = *written.fields[field];
    of_scene = !value.known();  // a value in error causes no further problem
    if (value.size == 3) {
      into = {value.c[0], value.c[1], value.c[2]};
    } else if (value.known()) {
      problems_.error(value.place, fmt::format("'{}' is a vector of three: <x, y, z>", kFieldWords[field]));
      of_scene = true;
    }
  }

  void read_angle(const WrittenKey& written) {
    if (!written.fields[kAngle]) return;
    const Value& value = *written.fields[kAngle];
    const std::optional<double> angle = number(value, "angle", problems_);
    camera_.of_scene.angle = !angle;
    if (!angle) return;
    camera_.angle_degrees = *angle;
    if (!(*angle > 0 && *angle < 180)) {
      problems_.error(value.place, fmt::format("'angle' is between 0 and 180 degrees, not {}", *angle));
    }
  }

  void read_number(const WrittenKey& written, Field field, double least, double& into) {
    if (!written.fields[field]) return;
    const Value& value = *written.fields[field];
    const std::optional<double> given = number(value, kFieldWords[field], problems_);
    if (!given) return;
    if (*given >= least && *given <= 1) {
      into = *given;
    } else {
      problems_.error(value.place,
                      fmt::format("'{}' is from {} to 1, not {}", kFieldWords[field], least, *given));
    }
  }

  // Reports a defect only at a key that changes the camera, so that one mistake is reported once. A camera
  // that takes fields from the scene is left to check_cameras.
  void check_camera(const WrittenKey& written) {
    if (!written.fields[kFrom] && !written.fields[kAt] && !written.fields[kUp]) return;
    const SceneFields& open = camera_.of_scene;
    if (open.from || open.at || open.up) return;
    const std::string_view defect = camera_defect(camera_.from, camera_.at, camera_.up);
    if (!defect.empty()) report_at(written, {kUp, kAt, kFrom}, std::string(defect));
  }

  // Reports at the first of these fields that the key has.
  void report_at(const WrittenKey& written, std::initializer_list<Field> fields, std::string message) {
    for (const Field field : fields) {
      if (!written.fields[field]) continue;
      problems_.error(written.fields[field]->place, std::move(message));
      return;
    }
    problems_.error(written.place, std::move(message));
  }

  Animation& animation_;
  bool fps_given_;
  Problems& problems_;
  CameraKey camera_;
  bool first_ = true;
};

// Sets the number of frames. Without `frames` the animation ends with its last key, of the camera or of an
// object.
void set_frame_count(const WrittenScript& script, Animation& animation, Problems& problems) {
  double last = animation.keys.empty() ? 1 : animation.keys.back().frame;
  for (const ObjectMotion& object : animation.objects) {
    if (!object.keys.empty()) last = std::max(last, object.keys.back().frame);
  }
  if (!script.frames) {
    animation.frames = static_cast<int>(std::ceil(last));
    return;
  }
  std::vector<WrittenKey> all = script.keys;
  for (const WrittenObject& object : script.objects)
    all.insert(all.end(), object.keys.begin(), object.keys.end());
  for (const WrittenKey& written : all) {
    if (!written.when.known()) continue;
    const double frame = written.in_seconds ? 1 + written.when.c[0] * animation.fps : written.when.c[0];
    if (frame > animation.frames) {
      problems.warning(written.when.place,
                       fmt::format("frame {} is beyond the last one, {}", frame, animation.frames));
    }
  }
}

}  // namespace

std::optional<double> number(const Value& value, std::string_view what, Problems& problems) {
  if (!value.known()) return std::nullopt;
  if (value.size == 1) return value.c[0];
  problems.error(value.place, fmt::format("'{}' is a number, not a vector", what));
  return std::nullopt;
}

std::optional<double> frame_of(const WrittenKey& written, const Animation& animation, bool fps_given,
                               Problems& problems) {
  const std::optional<double> when = number(written.when, "key", problems);
  if (!when) return std::nullopt;
  if (written.in_seconds && animation.fps == 0) {
    if (!fps_given) problems.error(written.when.place, "a time in seconds needs 'fps' in the animation");
    return std::nullopt;
  }
  const double frame = written.in_seconds ? 1 + *when * animation.fps : *when;
  if (frame >= 1 && frame <= kMostFrames) return frame;
  problems.error(
      written.when.place,
      frame < 1 ? fmt::format("frame {} is before the first one: frames count from 1, seconds from 0", frame)
                : fmt::format("frame {} is beyond the last possible one, {}", frame, kMostFrames));
  return std::nullopt;
}

bool is_in_order(double frame, const WrittenKey& written, const double* before, SourceLocation before_at,
                 Problems& problems) {
  if (before == nullptr || frame > *before) return true;
  problems.error(
      written.when.place,
      frame == *before
          ? fmt::format("frame {} has its key already, in line {}", frame, before_at.line)
          : fmt::format("frame {} comes after frame {} of line {}: keys stand in the order of time", frame,
                        *before, before_at.line));
  return false;
}

Animation interpret(const WrittenScript& script, std::string_view file_name, Problems& problems) {
  Animation animation;
  animation.name = file_name;
  animation.scene = script.scene;
  if (script.scene) animation.scene_location = problems.location(script.scene_place);
  if (script.frames) interpret_frames(*script.frames, animation, problems);
  if (script.fps) interpret_fps(*script.fps, animation, problems);
  if (script.resolution) interpret_resolution(*script.resolution, animation, problems);
  animation.spline = script.spline.value_or(SplineKind::kTcb);

  KeyReader reader(animation, script.fps.has_value(), problems);
  for (const WrittenKey& key : script.keys) reader.read(key);
  for (const WrittenObject& object : script.objects)
    animation.objects.push_back(interpret_object(object, animation, script.fps.has_value(), problems));
  animation.daylight = interpret_daylight(script, problems);
  set_frame_count(script, animation, problems);
  return animation;
}

}  // namespace pprt::anim
