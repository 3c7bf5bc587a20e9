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

  // Return false where there is no such key, or nothing to undo.
  bool drop(int frame);
  bool undo();

  bool can_undo() const { return !before_.empty(); }
  const std::vector<CameraKey>& keys() const { return keys_; }  // ascending by frame

  // The last key's frame; 0 without keys.
  int frames() const { return keys_.empty() ? 0 : static_cast<int>(keys_.back().frame); }

 private:
  void note();

  std::vector<CameraKey> keys_;
  std::vector<std::vector<CameraKey>> before_;  // each change, the last one last
};

}  // namespace pprt
