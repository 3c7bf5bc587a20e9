#include "scene/camera_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pprt {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHalfPi = kPi / 2;

// Below this share of the scale at hand a difference of two keys is rounding (a few ulps of 1e-16 each, from
// expressions such as R*cos(120)), not movement.
constexpr double kNoMovement = 1e-12;

// Bound of the logarithms: lengths from 1e-130 to 1e130; angles 1e-11 degrees short of 0 and 180.
// Only splines through absurd keys swing so far.
constexpr double kMostDistance = 300;
constexpr double kMostZoom = 30;

double radians(double degrees) {
  return degrees * (kPi / 180);
}

// Rotation of v about a unit axis, counter-clockwise seen from the axis' tip (Rodrigues).
Vec3d rotated(const Vec3d& v, const Vec3d& axis, double angle) {
  const double c = std::cos(angle);
  return v * c + axis.cross(v) * std::sin(angle) + axis * (axis.dot(v) * (1 - c));
}

// The frame in which heading and pitch are told; `up` is the key's up, x and y complete it.
struct Horizon {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, up{0, 0, 1};
};

Horizon rotated(const Horizon& h, const Vec3d& axis, double angle) {
  return {rotated(h.x, axis, angle), rotated(h.y, axis, angle), rotated(h.up, axis, angle)};
}

Vec3d direction(const Horizon& h, double heading, double pitch) {
  return (h.x * std::cos(heading) + h.y * std::sin(heading)) * std::cos(pitch) + h.up * std::sin(pitch);
}

// What is interpolated as a number of its own, or its change over a frame or a span. Radians, logarithms.
struct Channels {
  double heading = 0;   // about up, unwrapped
  double pitch = 0;     // above the plane across up
  double lean = 0;      // turn of up itself, about the span's axis
  double distance = 0;  // log |at - from|: an even zoom is an even change
  double zoom = 0;      // log tan(angle / 2), likewise; every value is an angle in (0, 180)
};

constexpr double Channels::*kEach[] = {&Channels::heading, &Channels::pitch, &Channels::lean,
                                       &Channels::distance, &Channels::zoom};

// A key in these terms.
struct Pose {
  double frame = 0;
  Vec3d from{0, 0, 0};
  Vec3d line{0, 0, 1};     // line of sight: at - from
  Vec3d forward{0, 0, 1};  // unit
  Horizon horizon;
  Channels value;
};

// The way from one pose to the next.
struct Leg {
  double frames = 1;
  Channels change;
  Vec3d axis{0, 0, 1};  // about which up leans, unit
  Vec3d eye{0, 0, 0};   // change of the eye
  Vec3d line{0, 0, 0};  // change of the line of sight
  double pivot = 0;     // see pivot_share
  bool still = false;   // both ends show the same picture
  bool pinned = false;  // the pivot stands still
  double scale = 1;     // length against which movement of points is judged
};

// Rates of change per frame on the two sides of a key.
template <typename T>
struct Sides {
  T in = T{0}, out = T{0};  // Imath's vectors are not zero by default
};

// Shortest axis and angle that take unit vector a to unit vector b; opposite ones turn about `spare`.
std::pair<Vec3d, double> turn_between(const Vec3d& a, const Vec3d& b, const Vec3d& spare) {
  const Vec3d normal = a.cross(b);
  const double sine = normal.length();
  const double angle = std::atan2(sine, a.dot(b));
  if (angle < kNoMovement) return {spare, 0.0};
  if (sine < kNoMovement) return {spare, kPi};
  return {normal / sine, angle};
}

// The heading difference brought to (-180, 180] degrees; half turns, to rounding, go counter-clockwise.
double shortest_turn(double heading_change) {
  const double turn = std::remainder(heading_change, 2 * kPi);
  return turn <= -kPi * (1 - 1e-9) ? turn + 2 * kPi : turn;
}

double heading_of(const Vec3d& forward, const Horizon& h) {
  return std::atan2(forward.dot(h.y), forward.dot(h.x));
}

// The point of the line of sight, as a share of it, that moves least from one key to the next: 0 the eye (it
// turns where it stands), 1 the target (it is gone round), between the two whatever the movement suggests.
double pivot_share(const Leg& leg) {
  const double turned = leg.line.length2();
  if (turned <= leg.scale * leg.scale * kNoMovement * kNoMovement) return 0;
  return std::clamp(-leg.eye.dot(leg.line) / turned, 0.0, 1.0);
}

Leg leg_between(const Pose& a, const CameraKey& key_a, Pose& b, const CameraKey& key_b) {
  Leg leg;
  leg.frames = b.frame - a.frame;
  leg.still = same_camera(key_a, key_b);
  leg.scale = std::max({a.from.length(), b.from.length(), a.line.length(), b.line.length()});
  leg.eye = b.from - a.from;
  leg.line = b.line - a.line;
  leg.pivot = pivot_share(leg);
  leg.pinned = (leg.eye + leg.line * leg.pivot).length() <= leg.scale * kNoMovement;

  const Vec3d level = (a.forward - a.horizon.up * a.forward.dot(a.horizon.up)).normalized();
  const auto [axis, lean] = turn_between(a.horizon.up, key_b.up.normalized(), level);
  leg.axis = axis;
  b.horizon = rotated(a.horizon, axis, lean);
  b.value.lean = a.value.lean + lean;
  b.value.heading = a.value.heading + shortest_turn(heading_of(b.forward, b.horizon) - a.value.heading);
  b.value.pitch = std::asin(std::clamp(b.forward.dot(b.horizon.up), -1.0, 1.0));
  for (double Channels::*c : kEach) leg.change.*c = b.value.*c - a.value.*c;
  return leg;
}

// A pose but for what depends on the pose before it.
Pose pose_of(const CameraKey& key) {
  Pose pose;
  pose.frame = key.frame;
  pose.from = key.from;
  pose.line = key.at - key.from;
  pose.forward = pose.line.normalized();
  pose.value.distance = std::log(pose.line.length());
  pose.value.zoom = std::log(std::tan(radians(key.angle_degrees) / 2));
  return pose;
}

void lay_first_horizon(Pose& pose, const CameraKey& key) {
  Horizon& h = pose.horizon;
  h.up = key.up.normalized();
  h.x = (pose.forward - h.up * pose.forward.dot(h.up)).normalized();
  h.y = h.up.cross(h.x);
  pose.value.pitch = std::asin(std::clamp(pose.forward.dot(h.up), -1.0, 1.0));
}

bool stands(double change) {
  return std::abs(change) <= kNoMovement;
}

// Rates at a key from the changes over the legs on its two sides.
//
// Kochanek and Bartels, "Interpolating splines with local tension, continuity, and bias control", SIGGRAPH
// 1984: equations 8 and 9, with their adjustment for legs of unequal length, which here is the division by
// the mean length. Where a value stands on one side it is at rest on both, so that it does not overshoot.
template <typename T>
Sides<T> key_rates(const T& before, const T& after, const Leg& in, const Leg& out, const CameraKey& key,
                   bool at_rest) {
  if (at_rest) return {};
  const double t = 1 - key.tension;
  const double before_share = t * (1 + key.bias) / 2;
  const double after_share = t * (1 - key.bias) / 2;
  const double less = 1 - key.continuity;
  const double more = 1 + key.continuity;
  const double mean_frames = (in.frames + out.frames) / 2;
  return {(before * (before_share * less) + after * (after_share * more)) / mean_frames,
          (before * (before_share * more) + after * (after_share * less)) / mean_frames};
}

// A cubic whose control points stay below the poles does too (convex hull), so the pitch may move by no more
// than half of what is left to the pole over a third of either leg.
double limited_pitch_rate(double rate, double pitch, double longest_leg) {
  const double most = 1.5 * (kHalfPi - std::abs(pitch)) / longest_leg;
  return std::clamp(rate, -most, most);
}

Sides<Channels> channel_rates(const Pose& pose, const Leg& in, const Leg& out, const CameraKey& key,
                              bool at_rest) {
  Sides<Channels> rates;
  for (double Channels::*c : kEach) {
    const double before = in.change.*c;
    const double after = out.change.*c;
    const Sides<double> r =
        key_rates(before, after, in, out, key, at_rest || stands(before) || stands(after));
    rates.in.*c = r.in;
    rates.out.*c = r.out;
  }
  // Up leans about one axis a leg: it goes on only where the next axis is the same.
  if (in.axis.dot(out.axis) < 1 - 1e-9) rates.in.lean = rates.out.lean = 0;
  const double longest = std::max(in.frames, out.frames);
  rates.in.pitch = limited_pitch_rate(rates.in.pitch, pose.value.pitch, longest);
  rates.out.pitch = limited_pitch_rate(rates.out.pitch, pose.value.pitch, longest);
  return rates;
}

// Rate of the line of sight that follows from the channels' rates.
Vec3d line_rate(const Pose& pose, const Vec3d& lean_axis, const Channels& rate) {
  const Channels& v = pose.value;
  const Horizon& h = pose.horizon;
  const Vec3d turning = direction(h, v.heading + kHalfPi, 0) * (std::cos(v.pitch) * rate.heading) +
                        direction(h, v.heading, v.pitch + kHalfPi) * rate.pitch +
                        lean_axis.cross(pose.forward) * rate.lean;
  return (pose.forward * rate.distance + turning) * pose.line.length();
}

// What the camera does at a key, on both sides of it.
struct KeyMotion {
  Sides<Channels> channels;
  Sides<Vec3d> eye;   // velocity of the eye
  Sides<Vec3d> line;  // and of the line of sight
};

// The eye's velocity at a key is one for both legs, though their pivots differ: it is the pivot's velocity
// less the line's turning about it. A leg whose pivot stands decides the pivot; between two such legs with
// different pivots (from going round a point to turning on the spot) the camera comes to rest.
KeyMotion key_motion(const Pose& pose, const Leg& in, const Leg& out, const CameraKey& key) {
  const bool clash = in.pinned && out.pinned && std::abs(in.pivot - out.pivot) > kNoMovement;
  const bool at_rest = in.still || out.still || clash;
  KeyMotion motion;
  motion.channels = channel_rates(pose, in, out, key, at_rest);
  motion.line = {line_rate(pose, in.axis, motion.channels.in),
                 line_rate(pose, out.axis, motion.channels.out)};

  const double pivot = in.pinned ? in.pivot : out.pinned ? out.pivot : (in.pivot + out.pivot) / 2;
  const Sides<Vec3d> pivot_rate = key_rates(in.eye + in.line * pivot, out.eye + out.line * pivot, in, out,
                                            key, at_rest || in.pinned || out.pinned);
  motion.eye = {pivot_rate.in - motion.line.in * pivot, pivot_rate.out - motion.line.out * pivot};
  return motion;
}

// Cubic Hermite over a leg: end values 0 and `change`, rates per frame at the ends.
template <typename T>
T hermite(const T& change, const T& rate_0, const T& rate_1, double frames, double s) {
  const double r = 1 - s;
  return change * (s * s * (3 - 2 * s)) + rate_0 * (frames * s * r * r) - rate_1 * (frames * s * s * r);
}

// The keys of a window as poses and legs. A key without a neighbour has the leg it has on both sides.
struct Window {
  std::array<Pose, 4> poses;
  std::array<Leg, 3> legs;
  std::size_t leg_count = 0;

  explicit Window(std::span<const CameraKey> keys) : leg_count(keys.size() - 1) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      poses[i] = pose_of(keys[i]);
      if (i == 0) {
        lay_first_horizon(poses[0], keys[0]);
      } else {
        legs[i - 1] = leg_between(poses[i - 1], keys[i - 1], poses[i], keys[i]);
      }
    }
  }

  KeyMotion motion_at(std::size_t key, const CameraKey& shape) const {
    const Leg& in = legs[key > 0 ? key - 1 : 0];
    const Leg& out = legs[key < leg_count ? key : leg_count - 1];
    return key_motion(poses[key], in, out, shape);
  }
};

// Even movement over one leg, as if its ends had no neighbours.
KeyMotion linear_motion(const Leg& leg) {
  KeyMotion motion;
  for (double Channels::*c : kEach) motion.channels.in.*c = leg.change.*c / leg.frames;
  motion.channels.out = motion.channels.in;
  return motion;
}

}  // namespace

double eased(double u, double ease_in, double ease_out) {
  const double full_speed = 2 / (2 - ease_in - ease_out);
  if (u < ease_in) return full_speed * u * u / (2 * ease_in);
  const double left = 1 - u;
  if (left < ease_out) return 1 - full_speed * left * left / (2 * ease_out);
  return full_speed * (u - ease_in / 2);
}

bool same_camera(const CameraKey& a, const CameraKey& b) {
  return a.from == b.from && a.at == b.at && a.up == b.up && a.angle_degrees == b.angle_degrees;
}

CameraKey camera_between(std::span<const CameraKey> keys, std::size_t span, double frame, SplineKind spline) {
  const Window window(keys);
  const Pose& pose = window.poses[span];
  const Leg& leg = window.legs[span];
  if (leg.still) return keys[span];

  const bool even = spline == SplineKind::kLinear;
  const KeyMotion start = even ? linear_motion(leg) : window.motion_at(span, keys[span]);
  const KeyMotion end = even ? linear_motion(leg) : window.motion_at(span + 1, keys[span + 1]);
  const CameraKey& to = keys[span + 1];
  const double s = eased((frame - pose.frame) / leg.frames, to.ease_in, to.ease_out);

  Channels now;
  for (double Channels::*c : kEach) {
    now.*c = pose.value.*c + hermite(leg.change.*c, start.channels.out.*c, end.channels.in.*c, leg.frames, s);
  }
  const Horizon horizon = rotated(pose.horizon, leg.axis, now.lean - pose.value.lean);
  const Vec3d line = direction(horizon, now.heading, now.pitch) *
                     std::exp(std::clamp(now.distance, -kMostDistance, kMostDistance));

  const Vec3d pivot_change = leg.eye + leg.line * leg.pivot;
  const Vec3d even_rate = pivot_change / leg.frames;
  const Vec3d rate_0 = even ? even_rate : start.eye.out + start.line.out * leg.pivot;
  const Vec3d rate_1 = even ? even_rate : end.eye.in + end.line.in * leg.pivot;
  Vec3d pivot = keys[span].from * (1 - leg.pivot) + keys[span].at * leg.pivot;
  if (!leg.pinned) pivot += hermite(pivot_change, rate_0, rate_1, leg.frames, s);

  CameraKey camera = keys[span];
  camera.from = pivot - line * leg.pivot;
  camera.at = pivot + line * (1 - leg.pivot);
  camera.up = horizon.up;
  camera.angle_degrees = 2 * std::atan(std::exp(std::clamp(now.zoom, -kMostZoom, kMostZoom))) * (180 / kPi);
  return camera;
}

}  // namespace pprt
