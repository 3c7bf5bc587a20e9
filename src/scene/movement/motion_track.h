// Movement of an object by keys, as AFF has it: translation, rotation and scale, each with keys of its own.
//
// Splines are those of Kochanek and Bartels (SIGGRAPH 1984). Rotations are quaternions on Shoemake's squad
// (SIGGRAPH 1985, course notes 1987), whose tangents are chosen by the same rules.
#pragma once

#include <vector>

#include "base/affine.h"
#include "base/vector.h"

namespace pprt {

// How a spline passes a key; Kochanek and Bartels.
struct KeyShape {
  double tension = 0, continuity = 0, bias = 0;
};

struct VectorKey {
  double time = 0;  // seconds
  Vec3d value{0, 0, 0};
  KeyShape shape = {};
};

// An orientation: a turn about an axis of any length, counter-clockwise seen from its tip. A zero axis: no
// turn. Full turns count for nothing; between two keys the short way is taken.
struct RotationKey {
  double time = 0;
  Vec3d axis{0, 0, 1};
  double degrees = 0;
  KeyShape shape = {};
};

// From this key on.
struct VisibilityKey {
  double time = 0;
  bool visible = true;
};

// The first three lists have no keys, or at least four. Their curves run from the second key to the last but
// one, and stand still before and after. The first and the last key only shape them.
//
// Keys at equal times make a jump; the later key holds from that time on. Keys at decreasing times are passed
// over: at each time the first segment counts that ends later.
struct MotionTrack {
  std::vector<VectorKey> translation, scale;
  std::vector<RotationKey> rotation;
  std::vector<VisibilityKey> visibility;  // visible before the first
  bool is_in_order = false;  // no time in a list is less than the one before; then it is found faster
};

inline constexpr std::size_t kLeastCurveKeys = 4;

// A track at one time.
struct Placement {
  Affine to_parent;  // scale, then rotation, then translation
  bool visible = true;
};

// The parts of a placement.
struct TrackValues {
  Vec3d scale{1, 1, 1};
  Affine rotation;
  Vec3d translation{0, 0, 0};
  bool visible = true;
};

// Notes whether the times are in order.
void note_order(MotionTrack& track);

// Always finite for finite keys.
TrackValues values_at(const MotionTrack& track, double time);

// Returns them as one map.
Placement placement_at(const MotionTrack& track, double time);

// What a track reaches at all times.
struct TrackReach {
  Box3d translation;  // contains every one
  double scale = 1;   // no factor's magnitude is greater
};
TrackReach reach_of(const MotionTrack& track);

// Returns a turn about an axis of any length; zero: none.
Affine rotation(const Vec3d& axis, double degrees);

// Returns the turn that a map makes, which must not stretch or mirror, as a key. Its angle is at most 180
// degrees.
RotationKey rotation_key(double time, const Affine& turn);

}  // namespace pprt
