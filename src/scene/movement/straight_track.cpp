#include "scene/movement/straight_track.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pprt {
namespace {

// Two segments meet in a key. One with less than half of this share of both lengths is a jump.
constexpr double kJumpShare = 1e-9;

// Returns the shape of a key whose two tangents equal the changes of the segments before and after it.
//
// Let the continuity be -1. Then the tangents are (1 - s)(1 + b) g1 d0 and (1 - s)(1 - b) g0 d. Twice the
// segments' shares of both lengths are g1 and g0. Tension s and bias b make both factors 1.
KeyShape straight_shape(double before, double after) {
  const double both = before + after;
  if (!(both > 0)) return {.tension = 0, .continuity = -1, .bias = 0};
  const double g1 = 2 * before / both, g0 = 2 * after / both;
  if (std::min(g0, g1) < kJumpShare) return {.tension = 0.5, .continuity = -1, .bias = 0};
  return {.tension = 1 - 1 / (g0 * g1), .continuity = -1, .bias = (g0 - g1) / 2};
}

template <typename Key>
void make_straight_keys(std::vector<Key>& keys) {
  if (keys.size() == 1) keys.push_back(keys[0]), keys.back().time += 1;
  Key ahead = keys.front(), behind = keys.back();
  ahead.time -= 1, behind.time += 1;
  keys.insert(keys.begin(), ahead);
  keys.push_back(behind);
  for (std::size_t i = 1; i + 1 < keys.size(); ++i)
    keys[i].shape = straight_shape(keys[i].time - keys[i - 1].time, keys[i + 1].time - keys[i].time);
}

// What differs between two placements.
struct Difference {
  double translation = 0, scale = 0;  // lengths
  double turn = 0;                    // degrees
};

TrackValues between(const TrackValues& a, const TrackValues& b, double share) {
  TrackValues result = a;
  result.scale += (b.scale - a.scale) * share;
  result.translation += (b.translation - a.translation) * share;
  const RotationKey turn = rotation_key(0, b.rotation * inverse(a.rotation));
  result.rotation = rotation(turn.axis, turn.degrees * share) * a.rotation;
  return result;
}

Difference difference(const TrackValues& a, const TrackValues& b) {
  return {.translation = (a.translation - b.translation).length(),
          .scale = (a.scale - b.scale).length(),
          .turn = rotation_key(0, b.rotation * inverse(a.rotation)).degrees};
}

class Divider {
 public:
  Divider(std::vector<double> times, const std::function<TrackValues(double)>& values_at)
      : given_(std::move(times)), values_at_(values_at) {
    std::sort(given_.begin(), given_.end());
    given_.erase(std::unique(given_.begin(), given_.end()), given_.end());
  }

  std::vector<double> run() {
    measure();
    double begin = given_.front();
    times_.push_back(begin);
    for (std::size_t i = 1; i < given_.size(); ++i) {
      const double end = given_[i], before = end - kMoment * (given_.back() - given_.front());
      const bool jumps = before > begin && differ(values_at_(before), values_at_(end));
      if (jumps) divide(begin, before, 0);
      if (jumps) times_.push_back(before);
      if (!jumps) divide(begin, end, 0);
      times_.push_back(end);
      begin = end;
    }
    return std::move(times_);
  }

 private:
  static constexpr double kMoment = 1e-6;  // share of the whole time in which only a jump moves anything much
  static constexpr double kShareOfExtent = 2.5e-4;
  static constexpr double kTurn = 0.02;  // degrees
  static constexpr int kLargestDepth = 8;

  // Takes the extents at the quarters of all segments.
  void measure() {
    Box3d places, scales;
    for (std::size_t i = 0; i < given_.size(); ++i) {
      const double length = i + 1 < given_.size() ? given_[i + 1] - given_[i] : 0;
      for (const double share : {0.0, 0.25, 0.5, 0.75}) {
        const TrackValues values = values_at_(given_[i] + share * length);
        places.extendBy(values.translation);
        scales.extendBy(values.scale);
      }
    }
    tolerance_ = {.translation = kShareOfExtent * places.size().length(),
                  .scale = kShareOfExtent * scales.size().length(),
                  .turn = kTurn};
  }

  bool differ(const TrackValues& a, const TrackValues& b) const {
    const Difference d = difference(a, b);
    return a.visible != b.visible || d.translation > tolerance_.translation || d.scale > tolerance_.scale ||
           d.turn > tolerance_.turn;
  }

  // Appends the times between two.
  void divide(double begin, double end, int depth) {
    if (depth == kLargestDepth) return;
    const TrackValues first = values_at_(begin), last = values_at_(end);
    const auto strays = [&](double share) {
      return differ(values_at_(begin + share * (end - begin)), between(first, last, share));
    };
    if (!strays(0.25) && !strays(0.5) && !strays(0.75)) return;
    const double middle = begin + (end - begin) / 2;
    divide(begin, middle, depth + 1);
    times_.push_back(middle);
    divide(middle, end, depth + 1);
  }

  std::vector<double> given_;
  const std::function<TrackValues(double)>& values_at_;
  Difference tolerance_;
  std::vector<double> times_;
};

}  // namespace

void make_straight(std::vector<VectorKey>& keys) {
  make_straight_keys(keys);
}

void make_straight(std::vector<RotationKey>& keys) {
  make_straight_keys(keys);
}

std::vector<double> key_times(const MotionTrack& track) {
  std::vector<double> times;
  const auto add = [&](const auto& curve) {
    for (std::size_t i = 1; i + 1 < curve.size(); ++i) times.push_back(curve[i].time);
  };
  add(track.translation);
  add(track.scale);
  add(track.rotation);
  for (const VisibilityKey& key : track.visibility) times.push_back(key.time);
  return times;
}

std::vector<double> straight_times(std::vector<double> times,
                                   const std::function<TrackValues(double)>& values_at) {
  return Divider(std::move(times), values_at).run();
}

MotionTrack straight_track(const std::vector<double>& times,
                           const std::function<TrackValues(double)>& values_at) {
  MotionTrack track;
  for (const double time : times) {
    const TrackValues values = values_at(time);
    track.translation.push_back({time, values.translation});
    track.rotation.push_back(rotation_key(time, values.rotation));
    track.scale.push_back({time, values.scale});
  }
  make_straight(track.translation);
  make_straight(track.rotation);
  make_straight(track.scale);
  note_order(track);
  return track;
}

}  // namespace pprt
