// An animation script as plain values, and the camera at any of its frames.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/source_location.h"
#include "base/vector.h"
#include "scene/description/scene_description.h"
#include "scene/movement/motion_track.h"

namespace pprt {

// The version of the language of scripts, as a script may tell it (pprt-anim(5)).
inline constexpr int kScriptVersion = 1;

// kCatmullRom equals kTcb with tension, continuity and bias 0 at every key.
enum class SplineKind { kLinear, kCatmullRom, kTcb };

// The fields that no key has given so far: they come from the scene's own view.
struct SceneFields {
  bool from = false, at = false, up = false, angle = false;
};

// The camera at one moment. Fields that a key omits are copied from the key before; `of_scene` marks those
// that no key has given.
struct CameraKey {
  double frame = 1;  // frames count from 1; keys given in seconds: 1 + seconds * fps
  Vec3d from{0, 0, 0};
  Vec3d at{0, 0, 1};
  Vec3d up{0, 1, 0};
  double angle_degrees = 45;
  SceneFields of_scene;
  double tension = 0, continuity = 0, bias = 0;  // Kochanek and Bartels 1984
  // Shares of the segment before this key, in time: accelerating from rest, and slowing down to rest. Each in
  // [0, 1], their sum at most 1.
  double ease_in = 0, ease_out = 0;
  bool cut = false;   // nothing is interpolated or copied from the key before
  bool hold = false;  // same camera as the key before, which stands still until here
  SourceLocation location;
};

// An object's place at one moment. Fields that a key omits are copied from the key before.
struct ObjectKey {
  double frame = 1;
  Vec3d translate{0, 0, 0};
  Vec3d rotate{0, 0,
               0};  // degrees about the axes x, y and z, in this order, counter-clockwise from their tips
  Vec3d scale{1, 1, 1};  // first of all
  bool visible = true;   // from this key on
  KeyShape shape = {};
  SourceLocation location = {};
};

// Something that a script moves: what a scene calls by that name, or the objects of another scene's file.
struct ObjectMotion {
  std::string name;
  SourceLocation location;
  std::vector<ObjectKey> keys;  // strictly sorted by frame; none: it rests
};

// What a script lights a scene by.
struct Daylight {
  std::vector<Light> suns;  // beside the scene's own lights
  std::optional<Sky> sky;   // in place of the scene's own
};

// Adds it to a scene.
void add(const Daylight& daylight, SceneDescription& scene);

// Lower bound of fps: a frame lasts at most 1000 s, so that every animation ends.
inline constexpr double kLeastFramesPerSecond = 0.001;

// Invariant after validation: keys are strictly sorted by frame, and the first one has cut = hold = false.
struct Animation {
  std::string name;                  // file name, for messages
  std::optional<std::string> scene;  // as written: spd:..., or a path relative to the script
  SourceLocation scene_location;     // of the statement that names it
  int frames = 1;
  double fps = 0;  // 0: not given; otherwise from kLeastFramesPerSecond
  std::optional<int> width, height;
  SplineKind spline = SplineKind::kTcb;
  std::vector<CameraKey> keys;  // empty: the scene's own view throughout
  std::vector<ObjectMotion> objects = {};
  Daylight daylight = {};
};

// Returns the view at a frame (1 .. frames, fractions allowed). `base` is the scene's own view: it gives
// hither, the size, and every field that no key gives. At a key, and while the camera stands still, the
// result is exactly the key's camera. Interpolation: docs/decisions/0002-camera-interpolation.md.
View view_at(const Animation& animation, double frame, const View& base);

// Returns whether a camera cut lies between frame - 1 and frame.
bool cut_before(const Animation& animation, int frame);

// Returns why (from, at, up) makes no camera; empty if it makes one. The defects: the eye at its target, no
// up vector, up (nearly) parallel to the view.
std::string_view camera_defect(const Vec3d& from, const Vec3d& at, const Vec3d& up);

// Reports every key that makes no camera once `base` has filled in the fields of the scene.
void check_cameras(const Animation& animation, const View& base, Diagnostics& problems);

}  // namespace pprt
