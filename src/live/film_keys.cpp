#include "live/film_keys.h"

#include <algorithm>
#include <utility>

namespace pprt {
namespace {

CameraKey key_of(const View& view, int frame) {
  CameraKey key;
  key.frame = frame;
  key.from = view.from;
  key.at = view.at;
  key.up = view.up;
  key.angle_degrees = view.angle_degrees;
  return key;
}

}  // namespace

// The first key at the frame or after it.
FilmKeys::Keys::iterator FilmKeys::place_of(int frame) {
  return std::lower_bound(keys_.begin(), keys_.end(), frame,
                          [](const CameraKey& key, int wanted) { return key.frame < wanted; });
}

bool FilmKeys::set(int frame, const View& view) {
  const auto place = place_of(frame);
  const bool is_there = place != keys_.end() && place->frame == frame;
  if (!is_there && keys_.size() >= kMost) return false;
  note();
  if (is_there) {
    *place = key_of(view, frame);
  } else {
    keys_.insert(place, key_of(view, frame));
  }
  return true;
}

bool FilmKeys::drop(int frame) {
  const auto place = place_of(frame);
  if (place == keys_.end() || place->frame != frame) return false;
  note();
  keys_.erase(place);
  return true;
}

bool FilmKeys::move(int frame, int to) {
  const auto place = place_of(frame);
  if (place == keys_.end() || place->frame != frame) return false;
  if (frame == to) return true;
  note();
  CameraKey moved = *place;
  moved.frame = to;
  keys_.erase(place);
  std::erase_if(keys_, [to](const CameraKey& key) { return key.frame == to; });
  keys_.insert(place_of(to), moved);
  return true;
}

void FilmKeys::note() {
  constexpr std::size_t kMostKept = 100;
  if (before_.size() == kMostKept) before_.erase(before_.begin());
  before_.push_back(keys_);
  undone_.clear();
}

bool FilmKeys::exchange(std::vector<Keys>& from, std::vector<Keys>& to) {
  if (from.empty()) return false;
  to.push_back(std::exchange(keys_, std::move(from.back())));
  from.pop_back();
  return true;
}

}  // namespace pprt
