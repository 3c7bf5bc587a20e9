// The keys of a film that somebody records, with undo.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/animation/animation.h"
#include "scene/description/scene_description.h"

namespace pprt {

class FilmKeys {
 public:
  static constexpr std::size_t kMost = 1000;

  // Puts the view at a frame, from 1; a key that is there already is replaced. Returns false where there are
  // kMost.
  bool set(int frame, const View& view);

  // Return false where there is no such key, or nothing to undo or to do again. A key that is moved replaces
  // the one at its new frame.
  bool drop(int frame);
  bool move(int frame, int to);
  bool undo() { return exchange(before_, undone_); }
  bool redo() { return exchange(undone_, before_); }

  bool can_undo() const { return !before_.empty(); }
  bool can_redo() const { return !undone_.empty(); }
  const std::vector<CameraKey>& keys() const { return keys_; }  // ascending by frame

  // The last key's frame; 0 without keys.
  int frames() const { return keys_.empty() ? 0 : static_cast<int>(keys_.back().frame); }

 private:
  using Keys = std::vector<CameraKey>;
  Keys::iterator place_of(int frame);
  void note();
  bool exchange(std::vector<Keys>& from, std::vector<Keys>& to);

  Keys keys_;
  std::vector<Keys> before_;  // each change, the last one last
  std::vector<Keys> undone_;  // each that was undone since the last change, the last one last
};

}  // namespace pprt
