// Learns how much the colour behind an edge is that of the samples on the primitive seen there. The rest
// comes from all samples around: a primitive that none of them is on may hide what lies between them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "pipeline/lattice/local_errors.h"

namespace pprt {

class EdgeShare {
 public:
  EdgeShare() { clear(); }

  void clear() {
    sums_.fill({});
    update();
  }

  // Returns the share between `primitives`, two or more, where errors have this level.
  float of(int primitives, int error_level) const { return shares_[class_of(primitives, error_level)]; }

  // Notes a sample: how far it lies from the mean of all around in the direction of those on its primitive.
  // Both are sums over the channels: `along` of the products, `squared` of that direction's squares.
  void learn(int primitives, int error_level, float along, float squared) {
    Sums& sums = sums_[class_of(primitives, error_level)];
    sums.along += along, sums.squared += squared;
  }

  // Shares are the slopes of the regression of what was found.
  void update() {
    constexpr float kExpected = 0.75F, kDoubt = 0.5F;
    for (std::size_t i = 0; i < sums_.size(); ++i)
      shares_[i] =
          std::clamp((sums_[i].along + kDoubt * kExpected) / (sums_[i].squared + kDoubt), 0.0F, 1.0F);
  }

 private:
  struct Sums {
    float along = 0, squared = 0;
  };
  static constexpr std::size_t kClasses = std::size_t{3} * kErrorLevels;

  static std::size_t class_of(int primitives, int error_level) {
    return static_cast<std::size_t>((std::min(primitives, 4) - 2) * kErrorLevels + error_level);
  }

  std::array<Sums, kClasses> sums_{};
  std::array<float, kClasses> shares_{};
};

}  // namespace pprt
