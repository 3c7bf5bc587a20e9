// Learns how many pixels of a picture will show several surfaces, before it is known what is visible.
#pragma once

#include <algorithm>
#include <cstddef>

namespace pprt {

// Counts pairs of samples side by side that lie on different surfaces. The more they are, the more pixels are
// crossed by edges. How many more depends on the scene and is learned from pictures in which all was seen.
class MixedShare {
 public:
  // A picture begins: samples are noted anew.
  void begin() { pairs_ = differing_ = 0; }

  // Notes pairs of samples side by side, and how many of them lie on different surfaces.
  void note(std::size_t pairs, std::size_t differing) { pairs_ += pairs, differing_ += differing; }

  // The picture with these samples was seen: a share of its pixels shows several surfaces.
  void learn(double share) {
    constexpr double kShareOfNew = 0.5;
    if (differing_ > 0) per_differing_ += kShareOfNew * (std::min(share / differing(), 1.0) - per_differing_);
    last_ = share;
  }

  // Returns the share of the pixels that will show several surfaces: as in the last picture, if it was seen.
  double expected(bool was_seen) const { return was_seen ? last_ : per_differing_ * differing(); }

 private:
  double differing() const {
    return pairs_ > 0 ? static_cast<double>(differing_) / static_cast<double>(pairs_) : 0;
  }

  std::size_t pairs_ = 0, differing_ = 0;
  double last_ = 0;
  double per_differing_ = 0.5;  // .26 to .88 in the nine databases, base squares being eight pixels wide
};

}  // namespace pprt
