// Short ways to write keys and to look at views, for the tests of this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/animation/animation.h"

namespace pprt {

inline constexpr double kDegrees = 180 / std::numbers::pi;

inline CameraKey key_at(double frame, const Vec3d& from, const Vec3d& at, const Vec3d& up = {0, 0, 1},
                        double angle_degrees = 45) {
  CameraKey key;
  key.frame = frame;
  key.from = from;
  key.at = at;
  key.up = up;
  key.angle_degrees = angle_degrees;
  return key;
}

inline CameraKey hold_at(double frame, CameraKey key) {
  key.frame = frame;
  key.hold = true;
  return key;
}

inline CameraKey cut_at(CameraKey key) {
  key.cut = true;
  return key;
}

inline Animation animation_of(std::vector<CameraKey> keys, SplineKind spline = SplineKind::kTcb) {
  Animation animation;
  animation.frames = 100;
  animation.spline = spline;
  animation.keys = std::move(keys);
  return animation;
}

inline Vec3d forward_of(const View& view) {
  return (view.at - view.from).normalized();
}
inline Vec3d right_of(const View& view) {
  return forward_of(view).cross(view.up).normalized();
}
inline double heading_degrees(const View& view) {
  return std::atan2(forward_of(view).y, forward_of(view).x) * kDegrees;
}
inline double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).length(), a.dot(b)) * kDegrees;
}
inline bool same_view(const View& a, const View& b) {
  return a.from == b.from && a.at == b.at && a.up == b.up && a.angle_degrees == b.angle_degrees;
}

}  // namespace pprt
