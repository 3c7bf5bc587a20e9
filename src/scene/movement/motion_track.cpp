#include "scene/movement/motion_track.h"

#include <Imath/ImathQuat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pprt {
namespace {

using Quaternion = Imath::Quatd;

// --- The curve: which segment, how far in it, and its tangents

// A place on a curve: between keys `segment` and `segment + 1`.
struct CurvePlace {
  std::size_t segment = 1;
  double share = 0;  // of its time, 0 to 1
};

// The curve runs from the second key to the last but one. A segment that ends before it begins is never
// found.
template <typename Key>
CurvePlace place_at(const std::vector<Key>& keys, double time, bool in_order) {
  const std::size_t last = keys.size() - 2;
  if (time <= keys[1].time) return {1, 0};
  if (time >= keys[last].time) return {last - 1, 1};
  std::size_t j = 1;
  if (in_order) {
    const auto later = std::upper_bound(keys.begin() + 2, keys.begin() + static_cast<std::ptrdiff_t>(last),
                                        time, [](double t, const Key& key) { return t < key.time; });
    j = static_cast<std::size_t>(later - keys.begin()) - 1;
  } else {
    while (j + 1 < last && !(time < keys[j + 1].time)) ++j;
  }
  const double begin = keys[j].time, end = keys[j + 1].time;
  return {j, end > begin ? std::clamp((time - begin) / (end - begin), 0.0, 1.0) : 1};
}

// How much of a tangent, which belongs to two segments, counts in the one of `length`.
double share_of(double length, double both) {
  return both > 0 ? 2 * length / both : 0;
}

// Leaving a key with the changes before and after it; and reaching one.
template <typename Change>
Change leaving(const KeyShape& k, const Change& before, const Change& after) {
  return before * ((1 - k.tension) * (1 + k.continuity) * (1 + k.bias) / 2) +
         after * ((1 - k.tension) * (1 - k.continuity) * (1 - k.bias) / 2);
}
template <typename Change>
Change reaching(const KeyShape& k, const Change& before, const Change& after) {
  return before * ((1 - k.tension) * (1 - k.continuity) * (1 + k.bias) / 2) +
         after * ((1 - k.tension) * (1 + k.continuity) * (1 - k.bias) / 2);
}

struct KeyTangents {
  Vec3d out{0, 0, 0}, in{0, 0, 0};
};

// `changes`: from key j-1 to j, from j to j+1, and from j+1 to j+2, where j is the segment's first key.
template <typename Key>
KeyTangents key_tangents(const std::vector<Key>& keys, std::size_t j, const Vec3d& before,
                         const Vec3d& change, const Vec3d& after) {
  const double length = keys[j + 1].time - keys[j].time;
  return {
      .out = leaving(keys[j].shape, before, change) * share_of(length, keys[j + 1].time - keys[j - 1].time),
      .in = reaching(keys[j + 1].shape, change, after) * share_of(length, keys[j + 2].time - keys[j].time)};
}

Vec3d vector_at(const std::vector<VectorKey>& keys, double time, bool in_order) {
  const auto [j, u] = place_at(keys, time, in_order);
  const Vec3d &from = keys[j].value, &to = keys[j + 1].value;
  if (u <= 0) return from;
  if (u >= 1) return to;
  const auto [out, in] = key_tangents(keys, j, from - keys[j - 1].value, to - from, keys[j + 2].value - to);
  const double u2 = u * u, u3 = u2 * u;  // cubic Hermite
  return from * (2 * u3 - 3 * u2 + 1) + to * (3 * u2 - 2 * u3) + out * (u3 - 2 * u2 + u) + in * (u3 - u2);
}

// Returns a box that contains the curve: each segment stays within the control points of its Bezier form.
Box3d box_of(const std::vector<VectorKey>& keys) {
  Box3d box;
  for (std::size_t j = 1; j + 2 < keys.size(); ++j) {
    const Vec3d &from = keys[j].value, &to = keys[j + 1].value;
    const auto [out, in] = key_tangents(keys, j, from - keys[j - 1].value, to - from, keys[j + 2].value - to);
    for (const Vec3d& point : {from, from + out / 3, to - in / 3, to}) box.extendBy(point);
  }
  return box;
}

// --- Rotations

Quaternion quaternion_of(const Vec3d& axis, double degrees) {
  const double length = axis.length();
  if (!(length > 0)) return {};
  const double half = degrees * (std::numbers::pi / 360);
  return {std::cos(half), axis * (std::sin(half) / length)};
}

// Half the angle times the axis of a unit quaternion, and back.
Vec3d logarithm(const Quaternion& q) {
  const double sine = q.v.length();
  return sine > 0 ? q.v * (std::atan2(sine, q.r) / sine) : Vec3d(0, 0, 0);
}
Quaternion exponential(const Vec3d& v) {
  const double angle = v.length();
  return {std::cos(angle), angle > 0 ? v * (std::sin(angle) / angle) : v};
}

// From a to b as a local turn; the quaternions of neighbours are on the same side.
Vec3d turn_between(const Quaternion& a, const Quaternion& b) {
  return logarithm(~a * b);  // the conjugate: they are of unit length
}

Quaternion rotation_at(const std::vector<RotationKey>& keys, double time, bool in_order) {
  const auto [j, u] = place_at(keys, time, in_order);
  std::array<Quaternion, 4> q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = quaternion_of(keys[j - 1 + i].axis, keys[j - 1 + i].degrees);
    if (i > 0 && (q[i - 1] ^ q[i]) < 0) q[i] = -q[i];
  }
  if (u <= 0) return q[1];
  if (u >= 1) return q[2];
  const Vec3d change = turn_between(q[1], q[2]);
  const auto [out, in] = key_tangents(keys, j, turn_between(q[0], q[1]), change, turn_between(q[2], q[3]));
  const Quaternion a = q[1] * exponential((out - change) / 2), b = q[2] * exponential((change - in) / 2);
  return Imath::slerp(Imath::slerp(q[1], q[2], u), Imath::slerp(a, b, u), 2 * u * (1 - u)).normalized();
}

Affine affine_of(const Quaternion& q) {
  const double x = q.v.x, y = q.v.y, z = q.v.z, r = q.r;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + r * z), 2 * (x * z - r * y)},
          {2 * (x * y - r * z), 1 - 2 * (x * x + z * z), 2 * (y * z + r * x)},
          {2 * (x * z + r * y), 2 * (y * z - r * x), 1 - 2 * (x * x + y * y)},
          {0, 0, 0}};
}

// The last key in the list counts of those whose time has come.
bool visible_at(const std::vector<VisibilityKey>& keys, double time, bool in_order) {
  bool visible = true;
  if (in_order) {
    const auto later = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const VisibilityKey& key) { return t < key.time; });
    return later == keys.begin() || (later - 1)->visible;
  }
  for (const VisibilityKey& key : keys) {
    if (key.time <= time) visible = key.visible;
  }
  return visible;
}

}  // namespace

Affine rotation(const Vec3d& axis, double degrees) {
  return affine_of(quaternion_of(axis, degrees));
}

RotationKey rotation_key(double time, const Affine& map) {
  const Vec3d twice_sine(map.y.z - map.z.y, map.z.x - map.x.z, map.x.y - map.y.x);
  const double cosine = (map.x.x + map.y.y + map.z.z - 1) / 2, sine = twice_sine.length() / 2;
  const double angle = std::atan2(sine, cosine) * (180 / std::acos(-1.0));
  constexpr double kHalfTurn = 1e-6;  // there the difference above says nothing of the axis
  if (sine > kHalfTurn || cosine > 0) return {time, twice_sine, angle};
  const Vec3d columns[] = {map.x + Vec3d(1, 0, 0), map.y + Vec3d(0, 1, 0), map.z + Vec3d(0, 0, 1)};
  const auto longer = [](const Vec3d& a, const Vec3d& b) { return a.length2() < b.length2(); };
  return {time, *std::max_element(std::begin(columns), std::end(columns), longer), angle, {}};
}

void note_order(MotionTrack& track) {
  const auto is_ordered = [](const auto& keys) {
    return std::is_sorted(keys.begin(), keys.end(),
                          [](const auto& a, const auto& b) { return a.time < b.time; });
  };
  track.is_in_order = is_ordered(track.translation) && is_ordered(track.scale) &&
                      is_ordered(track.rotation) && is_ordered(track.visibility);
}

TrackValues values_at(const MotionTrack& track, double time) {
  TrackValues values;
  if (!track.scale.empty()) values.scale = vector_at(track.scale, time, track.is_in_order);
  if (!track.rotation.empty())
    values.rotation = affine_of(rotation_at(track.rotation, time, track.is_in_order));
  if (!track.translation.empty()) values.translation = vector_at(track.translation, time, track.is_in_order);
  values.visible = visible_at(track.visibility, time, track.is_in_order);
  return values;
}

TrackReach reach_of(const MotionTrack& track) {
  TrackReach reach;
  reach.translation = track.translation.empty() ? Box3d(Vec3d(0, 0, 0)) : box_of(track.translation);
  if (track.scale.empty()) return reach;
  const Box3d scales = box_of(track.scale);
  reach.scale = 0;
  for (int axis = 0; axis < 3; ++axis)
    reach.scale = std::max({reach.scale, std::abs(scales.min[axis]), std::abs(scales.max[axis])});
  return reach;
}

Placement placement_at(const MotionTrack& track, double time) {
  const TrackValues values = values_at(track, time);
  Affine map = values.rotation;
  map.x *= values.scale.x, map.y *= values.scale.y, map.z *= values.scale.z;
  map.origin = values.translation;
  return {.to_parent = map, .visible = values.visible};
}

}  // namespace pprt
