#include "scene/animation/camera_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pprt {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHalfPi = kPi / 2;

// Relative difference of two keys below which it is rounding (a few ulps of 1e-16, as in R*cos(120)), not
// movement.
constexpr double kNoMovement = 1e-12;

// Clamps of the logarithms: lengths stay within 1e-130 to 1e130, angles 1e-11 degrees away from 0 and 180.
// Only splines through absurd keys reach them.
constexpr double kMostDistance = 300;
constexpr double kMostZoom = 30;

double radians(double degrees) {
  return degrees * (kPi / 180);
}

// The frame in which heading and pitch are measured: `up` is the key's up, x and y complete it.
struct Horizon {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, up{0, 0, 1};
};

Horizon rotated_horizon(const Horizon& h, const Vec3d& axis, double angle) {
  return {rotated(h.x, axis, angle), rotated(h.y, axis, angle), rotated(h.up, axis, angle)};
}

Vec3d direction(const Horizon& h, double heading, double pitch) {
  return (h.x * std::cos(heading) + h.y * std::sin(heading)) * std::cos(pitch) + h.up * std::sin(pitch);
}

// The interpolated scalars, or their change over a frame or a segment. Radians and logarithms.
struct Channels {
  double heading = 0;   // about up, unwrapped
  double pitch = 0;     // above the plane normal to up
  double lean = 0;      // rotation of up itself, about the segment's axis
  double distance = 0;  // log |at - from|, so that an even zoom changes it evenly
  double zoom = 0;      // log tan(angle / 2), for the same reason; every value is an angle in (0, 180)
};

constexpr double Channels::*kEach[] = {&Channels::heading, &Channels::pitch, &Channels::lean,
                                       &Channels::distance, &Channels::zoom};

// A key expressed in these terms.
struct Pose {
  double frame = 0;
  Vec3d from{0, 0, 0};
  Vec3d line{0, 0, 1};     // line of sight: at - from
  Vec3d forward{0, 0, 1};  // unit
  Horizon horizon;
  Channels value;
};

// The movement from one pose to the next.
struct Segment {
  double frames = 1;
  Channels change;
  Vec3d axis{0, 0, 1};       // unit axis of the rotation of up
  Vec3d eye{0, 0, 0};        // change of the eye
  Vec3d line{0, 0, 0};       // change of the line of sight
  double pivot = 0;          // see pivot_share
  bool still = false;        // both ends show the same picture
  bool pivot_fixed = false;  // the pivot stands still
  double scale = 1;          // length against which movement of points is judged
};

// Rates of change per frame before and after a key (Kochanek and Bartels: source and destination derivative).
template <typename T>
struct Tangents {
  T in = T{0}, out = T{0};  // Imath's vectors are not zero by default
};

// Returns the shortest rotation, as axis and angle, from unit vector a to unit vector b. Opposite vectors
// rotate about `spare`.
std::pair<Vec3d, double> turn_between(const Vec3d& a, const Vec3d& b, const Vec3d& spare) {
  const Vec3d normal = a.cross(b);
  const double sine = normal.length();
  const double angle = std::atan2(sine, a.dot(b));
  if (angle < kNoMovement) return {spare, 0.0};
  if (sine < kNoMovement) return {spare, kPi};
  return {normal / sine, angle};
}

// Brings a heading difference to (-180, 180] degrees. Half turns, up to rounding, go counter-clockwise.
double shortest_turn(double heading_change) {
  const double turn = std::remainder(heading_change, 2 * kPi);
  return turn <= -kPi * (1 - 1e-9) ? turn + 2 * kPi : turn;
}

double heading_of(const Vec3d& forward, const Horizon& h) {
  return std::atan2(forward.dot(h.y), forward.dot(h.x));
}

// Returns the point of the line of sight that moves least from one key to the next, as a share of the line. 0
// is the eye (the camera turns on the spot), 1 the target (the camera orbits it).
double pivot_share(const Segment& segment) {
  const double turned = segment.line.length2();
  if (turned <= segment.scale * segment.scale * kNoMovement * kNoMovement) return 0;
  return std::clamp(-segment.eye.dot(segment.line) / turned, 0.0, 1.0);
}

Segment segment_between(const Pose& a, const CameraKey& key_a, Pose& b, const CameraKey& key_b) {
  Segment segment;
  segment.frames = b.frame - a.frame;
  segment.still = same_camera(key_a, key_b);
  segment.scale = std::max({a.from.length(), b.from.length(), a.line.length(), b.line.length()});
  segment.eye = b.from - a.from;
  segment.line = b.line - a.line;
  segment.pivot = pivot_share(segment);
  segment.pivot_fixed = (segment.eye + segment.line * segment.pivot).length() <= segment.scale * kNoMovement;

  const Vec3d level = (a.forward - a.horizon.up * a.forward.dot(a.horizon.up)).normalized();
  const auto [axis, lean] = turn_between(a.horizon.up, key_b.up.normalized(), level);
  segment.axis = axis;
  b.horizon = rotated_horizon(a.horizon, axis, lean);
  b.value.lean = a.value.lean + lean;
  b.value.heading = a.value.heading + shortest_turn(heading_of(b.forward, b.horizon) - a.value.heading);
  b.value.pitch = std::asin(std::clamp(b.forward.dot(b.horizon.up), -1.0, 1.0));
  for (double Channels::*c : kEach) segment.change.*c = b.value.*c - a.value.*c;
  return segment;
}

// Converts a key, except for what depends on the pose before it.
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

void set_first_horizon(Pose& pose, const CameraKey& key) {
  Horizon& h = pose.horizon;
  h.up = key.up.normalized();
  h.x = (pose.forward - h.up * pose.forward.dot(h.up)).normalized();
  h.y = h.up.cross(h.x);
  pose.value.pitch = std::asin(std::clamp(pose.forward.dot(h.up), -1.0, 1.0));
}

bool is_constant(double change) {
  return std::abs(change) <= kNoMovement;
}

// Returns the rates at a key from the changes over the segments on its two sides.
//
// Source: Kochanek and Bartels, "Interpolating splines with local tension, continuity, and bias control",
// SIGGRAPH 1984, equations 8 and 9. Their adjustment for segments of unequal length is the division by the
// mean length here. A value that is constant on one side is at rest on both, so it does not overshoot.
template <typename T>
Tangents<T> key_rates(const T& before, const T& after, const Segment& in, const Segment& out,
                      const CameraKey& key, bool at_rest) {
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

// Limits the pitch rate so that the pitch never passes a pole. A cubic stays in the convex hull of its
// control points. So within a third of either segment the pitch may use half of what is left to the pole.
double limited_pitch_rate(double rate, double pitch, double longest_segment) {
  const double most = 1.5 * (kHalfPi - std::abs(pitch)) / longest_segment;
  return std::clamp(rate, -most, most);
}

Tangents<Channels> channel_rates(const Pose& pose, const Segment& in, const Segment& out,
                                 const CameraKey& key, bool at_rest) {
  Tangents<Channels> rates;
  for (double Channels::*c : kEach) {
    const double before = in.change.*c;
    const double after = out.change.*c;
    const Tangents<double> r =
        key_rates(before, after, in, out, key, at_rest || is_constant(before) || is_constant(after));
    rates.in.*c = r.in;
    rates.out.*c = r.out;
  }
  // Up rotates about one axis per segment: the rate carries over only if the next axis is the same.
  if (in.axis.dot(out.axis) < 1 - 1e-9) rates.in.lean = rates.out.lean = 0;
  const double longest = std::max(in.frames, out.frames);
  rates.in.pitch = limited_pitch_rate(rates.in.pitch, pose.value.pitch, longest);
  rates.out.pitch = limited_pitch_rate(rates.out.pitch, pose.value.pitch, longest);
  return rates;
}

// Returns the rate of the line of sight that follows from the channels' rates.
Vec3d line_rate(const Pose& pose, const Vec3d& lean_axis, const Channels& rate) {
  const Channels& v = pose.value;
  const Horizon& h = pose.horizon;
  const Vec3d turning = direction(h, v.heading + kHalfPi, 0) * (std::cos(v.pitch) * rate.heading) +
                        direction(h, v.heading, v.pitch + kHalfPi) * rate.pitch +
                        lean_axis.cross(pose.forward) * rate.lean;
  return (pose.forward * rate.distance + turning) * pose.line.length();
}

// Movement at a key, on both sides of it.
struct KeyMotion {
  Tangents<Channels> channels;
  Tangents<Vec3d> eye;   // velocity of the eye
  Tangents<Vec3d> line;  // velocity of the line of sight
};

// Returns the movement at a key. The eye has one velocity on both sides, though the pivots may differ. It is
// the pivot's velocity minus the turning of the line of sight about it.
//
// A segment with a fixed pivot decides the pivot. Between two such segments with different pivots (an orbit,
// then a turn on the spot) the camera comes to rest.
KeyMotion key_motion(const Pose& pose, const Segment& in, const Segment& out, const CameraKey& key) {
  const bool clash = in.pivot_fixed && out.pivot_fixed && std::abs(in.pivot - out.pivot) > kNoMovement;
  const bool at_rest = in.still || out.still || clash;
  KeyMotion motion;
  motion.channels = channel_rates(pose, in, out, key, at_rest);
  motion.line = {line_rate(pose, in.axis, motion.channels.in),
                 line_rate(pose, out.axis, motion.channels.out)};

  const double pivot = in.pivot_fixed ? in.pivot : out.pivot_fixed ? out.pivot : (in.pivot + out.pivot) / 2;
  const Tangents<Vec3d> pivot_rate = key_rates(in.eye + in.line * pivot, out.eye + out.line * pivot, in, out,
                                               key, at_rest || in.pivot_fixed || out.pivot_fixed);
  motion.eye = {pivot_rate.in - motion.line.in * pivot, pivot_rate.out - motion.line.out * pivot};
  return motion;
}

// Cubic Hermite interpolation over a segment: end values 0 and `change`, rates per frame at both ends.
template <typename T>
T hermite(const T& change, const T& rate_0, const T& rate_1, double frames, double s) {
  const double r = 1 - s;
  return change * (s * s * (3 - 2 * s)) + rate_0 * (frames * s * r * r) - rate_1 * (frames * s * s * r);
}

// The given keys as poses and the segments between them. An end key uses its only segment on both sides.
struct Window {
  std::array<Pose, 4> poses;
  std::array<Segment, 3> segments;
  std::size_t segment_count = 0;

  explicit Window(std::span<const CameraKey> keys) : segment_count(keys.size() - 1) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      poses[i] = pose_of(keys[i]);
      if (i == 0) {
        set_first_horizon(poses[0], keys[0]);
      } else {
        segments[i - 1] = segment_between(poses[i - 1], keys[i - 1], poses[i], keys[i]);
      }
    }
  }

  KeyMotion motion_at(std::size_t key, const CameraKey& shape) const {
    const Segment& in = segments[key > 0 ? key - 1 : 0];
    const Segment& out = segments[key < segment_count ? key : segment_count - 1];
    return key_motion(poses[key], in, out, shape);
  }
};

// Even movement over one segment, as if its ends had no neighbours.
KeyMotion linear_motion(const Segment& segment) {
  KeyMotion motion;
  for (double Channels::*c : kEach) motion.channels.in.*c = segment.change.*c / segment.frames;
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

Vec3d rotated(const Vec3d& v, const Vec3d& axis, double angle) {
  const double c = std::cos(angle);
  return v * c + axis.cross(v) * std::sin(angle) + axis * (axis.dot(v) * (1 - c));
}

bool same_camera(const CameraKey& a, const CameraKey& b) {
  return a.from == b.from && a.at == b.at && a.up == b.up && a.angle_degrees == b.angle_degrees;
}

CameraKey camera_between(std::span<const CameraKey> keys, std::size_t first, double frame,
                         SplineKind spline) {
  const Window window(keys);
  const Pose& pose = window.poses[first];
  const Segment& segment = window.segments[first];
  if (segment.still) return keys[first];

  // Movement at both ends, and the share of the way.
  const bool even = spline == SplineKind::kLinear;
  const KeyMotion start = even ? linear_motion(segment) : window.motion_at(first, keys[first]);
  const KeyMotion end = even ? linear_motion(segment) : window.motion_at(first + 1, keys[first + 1]);
  const CameraKey& to = keys[first + 1];
  const double s = eased((frame - pose.frame) / segment.frames, to.ease_in, to.ease_out);

  // The line of sight, from the channels.
  Channels now;
  for (double Channels::*c : kEach) {
    now.*c = pose.value.*c +
             hermite(segment.change.*c, start.channels.out.*c, end.channels.in.*c, segment.frames, s);
  }
  const Horizon horizon = rotated_horizon(pose.horizon, segment.axis, now.lean - pose.value.lean);
  const Vec3d line = direction(horizon, now.heading, now.pitch) *
                     std::exp(std::clamp(now.distance, -kMostDistance, kMostDistance));

  // The pivot, which carries the line of sight.
  const Vec3d pivot_change = segment.eye + segment.line * segment.pivot;
  const Vec3d even_rate = pivot_change / segment.frames;
  const Vec3d rate_0 = even ? even_rate : start.eye.out + start.line.out * segment.pivot;
  const Vec3d rate_1 = even ? even_rate : end.eye.in + end.line.in * segment.pivot;
  Vec3d pivot = keys[first].from * (1 - segment.pivot) + keys[first].at * segment.pivot;
  if (!segment.pivot_fixed) pivot += hermite(pivot_change, rate_0, rate_1, segment.frames, s);

  CameraKey camera = keys[first];
  camera.from = pivot - line * segment.pivot;
  camera.at = pivot + line * (1 - segment.pivot);
  camera.up = horizon.up;
  camera.angle_degrees = 2 * std::atan(std::exp(std::clamp(now.zoom, -kMostZoom, kMostZoom))) * (180 / kPi);
  return camera;
}

}  // namespace pprt
