#include "convert/model/model_animation.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "base/printable.h"
#include "convert/model/model_builder.h"
#include "scene/movement/movement_limits.h"

namespace pprt {
namespace {

constexpr double kFramesPerSecond = 24;
constexpr double kRounding = 1e-3;  // of a frame: times are floats

// Frames from the first to the last key, both ends shown.
double frames_in(double seconds, double rate) {
  return std::ceil(seconds * rate - kRounding) + 1;
}

void require(bool is_usable) {
  if (!is_usable) throw std::runtime_error("a key of its animation is not finite, or beyond 1e100");
}

std::string quoted(const std::string& name) {
  return "'" + printable(name) + "'";
}

std::string listed(const std::vector<std::string>& names, std::size_t without) {
  constexpr std::size_t kMostNamed = 10;
  std::string list;
  for (std::size_t i = 0, named = 0; i < names.size(); ++i) {
    if (i == without) continue;
    if (named++ == kMostNamed) return list + " ...";
    list += (list.empty() ? "" : ", ") + quoted(names[i]);
  }
  return list;
}

}  // namespace

void require_usable(const VectorKey& key) {
  require(is_in_range(key.time) && is_in_range(key.value));
}

void require_usable(const RotationKey& key) {
  require(is_in_range(key.time) && is_in_range(key.degrees) && is_in_range(key.axis));
}

std::optional<FrameTimes> KeySpan::frames(std::vector<std::string>& notes) const {
  if (!(last_ > first_)) return std::nullopt;
  if (frames_in(last_ - first_, kFramesPerSecond) > kMostFrames)
    notes.push_back("it would have more than " + std::to_string(kMostFrames) +
                    " frames at 24 a second: these are further apart");
  return frames_between(first_, last_, kFramesPerSecond);
}

FrameTimes frames_between(double start, double end, double rate) {
  const double frames = std::min(frames_in(end - start, rate), double{kMostFrames});
  return {.start = start, .end = end, .frames = static_cast<int>(frames)};
}

std::string animation_taken(const std::vector<std::string>& names, std::size_t taken) {
  return "of " + std::to_string(names.size()) + " animations " + quoted(names[taken]) +
         " is shown; --animation takes another: " + listed(names, taken);
}

std::size_t animation_called(const std::vector<std::string>& names, const std::string& name) {
  if (name.empty()) return 0;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw std::runtime_error("it has no animation " + quoted(name) +
                           (names.empty() ? "" : ", but " + listed(names, names.size())));
}

}  // namespace pprt
