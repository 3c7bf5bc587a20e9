// Keys of movements, and the frames that show them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/movement/movement.h"
#include "scene/movement/straight_track.h"

namespace pprt {

struct ModelAnimation {
  std::map<std::string, MotionTrack> tracks;  // by their names
  std::optional<FrameTimes> times;            // from the first key to the last, 24 frames a second
  std::vector<std::string> notes;             // for people: what was left out
};

// Returns the frames of a rate that show this time, at most as many as a scene may have.
FrameTimes frames_between(double start, double end, double rate);

// From the first to the last key.
class KeySpan {
 public:
  void add(double time) { first_ = std::min(first_, time), last_ = std::max(last_, time); }

  // Returns its frames, of which there are at most as many as a scene may have; empty for one time or none.
  std::optional<FrameTimes> frames(std::vector<std::string>& notes) const;

 private:
  double first_ = std::numeric_limits<double>::infinity(), last_ = -first_;
};

// Throws std::runtime_error for a key that scene files cannot hold.
void require_usable(const VectorKey& key);
void require_usable(const RotationKey& key);

// Sorts keys, at least one, and joins them by straight lines.
template <typename Key>
void join(std::vector<Key>& keys, KeySpan& span) {
  std::stable_sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a.time < b.time; });
  span.add(keys.front().time), span.add(keys.back().time);
  make_straight(keys);
}

// Returns what tells which of several animations is shown, and the others. `taken`: its place among them.
std::string animation_taken(const std::vector<std::string>& names, std::size_t taken);

// Returns the place of an animation of a name; without a name the first. Throws std::runtime_error where
// there is none of that name.
std::size_t animation_called(const std::vector<std::string>& names, const std::string& name);

}  // namespace pprt
