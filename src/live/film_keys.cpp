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

bool FilmKeys::set(int frame, const View& view) {
  const auto place = std::lower_bound(keys_.begin(), keys_.end(), frame,
                                      [](const CameraKey& key, int wanted) { return key.frame < wanted; });
  const bool is_there = place != keys_.end() && place->frame == frame;
  if (!is_there && keys_.size() >= kMost) return false;
  const auto index = place - keys_.begin();
  note();
  if (is_there) {
    keys_[static_cast<std::size_t>(index)] = key_of(view, frame);
  } else {
    keys_.insert(keys_.begin() + index, key_of(view, frame));
  }
  return true;
}

bool FilmKeys::drop(int frame) {
  const auto is_it = [frame](const CameraKey& key) { return key.frame == frame; };
  if (std::none_of(keys_.begin(), keys_.end(), is_it)) return false;
  note();
  std::erase_if(keys_, is_it);
  return true;
}

bool FilmKeys::undo() {
  if (before_.empty()) return false;
  keys_ = std::move(before_.back());
  before_.pop_back();
  return true;
}

void FilmKeys::note() {
  constexpr std::size_t kMostKept = 100;
  if (before_.size() == kMostKept) before_.erase(before_.begin());
  before_.push_back(keys_);
}

}  // namespace pprt
