// An animation script as plain values, and the camera at any frame of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/source_location.h"
#include "base/vector.h"
#include "scene/scene_description.h"

namespace pprt {

enum class SplineKind { kLinear, kCatmullRom, kTcb };

// The camera at one moment; every field resolved (what a key did not give was taken from the key before).
struct CameraKey {
  double frame = 1;  // frames count from 1; keys given in seconds: 1 + seconds * fps
  Vec3d from{0, 0, 0};
  Vec3d at{0, 0, 1};
  Vec3d up{0, 1, 0};
  double angle_degrees = 45;
  double tension = 0, continuity = 0, bias = 0;  // Kochanek and Bartels 1984
  double ease_in = 0, ease_out = 0;              // share of the span spent accelerating / slowing down, 0..1
  bool cut = false;                              // nothing is interpolated or carried from the key before
  bool hold = false;  // same camera as the key before, which stands still until here
  SourceLocation location;
};

// Invariant (after validation): keys are sorted by frame, strictly; the first one has cut = hold = false.
struct Animation {
  std::string name;                  // file name, for messages
  std::optional<std::string> scene;  // as written: spd:..., or a path relative to the script
  int frames = 1;
  double fps = 0;  // 0: not given
  std::optional<int> width, height;
  SplineKind spline = SplineKind::kTcb;
  std::vector<CameraKey> keys;  // empty: the scene's own view throughout
};

// The camera at a frame (1 .. frames, fractions allowed), over `base` for what no key says (hither, size).
View view_at(const Animation& animation, double frame, const View& base);

// Whether a cut lies between frame - 1 and frame.
bool cut_before(const Animation& animation, int frame);

}  // namespace pprt
