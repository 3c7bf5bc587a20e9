// An animation script as plain values, and the camera at any frame of it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/source_location.h"
#include "base/vector.h"
#include "scene/scene_description.h"

namespace pprt {

// catmull_rom is tcb with tension, continuity and bias 0 at every key.
enum class SplineKind { kLinear, kCatmullRom, kTcb };

// Which fields of a key no key has given: they are the scene's own view's.
struct SceneFields {
  bool from = false, at = false, up = false, angle = false;
};

// The camera at one moment; what a key did not give was taken from the key before, and `of_scene` marks what
// neither had.
struct CameraKey {
  double frame = 1;  // frames count from 1; keys given in seconds: 1 + seconds * fps
  Vec3d from{0, 0, 0};
  Vec3d at{0, 0, 1};
  Vec3d up{0, 1, 0};
  double angle_degrees = 45;
  SceneFields of_scene;
  double tension = 0, continuity = 0, bias = 0;  // Kochanek and Bartels 1984
  // The way from the key before to this one: share of it spent accelerating from rest, and slowing down to
  // rest; 0..1, their sum at most 1.
  double ease_in = 0, ease_out = 0;
  bool cut = false;   // nothing is interpolated or carried from the key before
  bool hold = false;  // same camera as the key before, which stands still until here
  SourceLocation location;
};

// A frame lasts a quarter of an hour at most: one without end could not be waited for.
inline constexpr double kLeastFramesPerSecond = 0.001;

// Invariant (after validation): keys are sorted by frame, strictly; the first one has cut = hold = false.
struct Animation {
  std::string name;                  // file name, for messages
  std::optional<std::string> scene;  // as written: spd:..., or a path relative to the script
  int frames = 1;
  double fps = 0;  // 0: not given; otherwise from kLeastFramesPerSecond
  std::optional<int> width, height;
  SplineKind spline = SplineKind::kTcb;
  std::vector<CameraKey> keys;  // empty: the scene's own view throughout
};

// The camera at a frame (1 .. frames, fractions allowed), over `base`, the scene's own view, for what no key
// says. hither and size are always those of `base`. Exactly a key's camera at a key and where it stands
// still. How the camera moves between keys: docs/decisions/0002-camera-interpolation.md.
View view_at(const Animation& animation, double frame, const View& base);

// Whether a cut lies between frame - 1 and frame.
bool cut_before(const Animation& animation, int frame);

// What makes (from, at, up) no camera: the eye at its target, or `up` (nearly) along the view; empty when
// nothing does.
std::string_view camera_defect(const Vec3d& from, const Vec3d& at, const Vec3d& up);

// Reports the keys that are no camera once `base` has filled in what they leave open.
void check_cameras(const Animation& animation, const View& base, Diagnostics& problems);

}  // namespace pprt
