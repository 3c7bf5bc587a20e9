// Learns how much the colour of a surface is that of the few samples on it. The rest comes from all samples
// around: in mirrors one point of a surface says little about the next.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "pipeline/core/octaves.h"

namespace pprt {

// What a prediction rests on.
enum class Basis : std::uint8_t {
  kAllAround,   // all nodes around lie on the surface seen
  kSome,        // at least two do
  kOne,         // one does
  kNearSample,  // none does, but a sample near by
  kShading,     // no sample does, but which lights are seen is known of others around
  kNothing      // the mean of other surfaces
};
inline constexpr int kBases = 6;

inline Basis basis_of(std::size_t on_surface, std::size_t around) {
  return on_surface == around ? Basis::kAllAround : on_surface > 1 ? Basis::kSome : Basis::kOne;
}

class SurfaceShare {
 public:
  SurfaceShare() { clear(); }

  void clear() {
    sums_.fill({});
    update();
  }

  // Returns the share where errors have this level.
  float of(Basis basis, int error_level) const { return shares_[class_of(basis, error_level)]; }

  // Returns the part of a surface's squared error that one sample alone takes away, in the mean of all
  // levels.
  float gain_of_one() const { return of_one_ * of_one_; }

  // Notes a sample: how far it lies from the mean of all around in the direction of those on its surface.
  // Both are sums over the channels: `along` of the products, `squared` of that direction's squares.
  void learn(Basis basis, int error_level, float along, float squared) {
    Sums& sums = sums_[class_of(basis, error_level)];
    sums.along += along, sums.squared += squared;
  }

  // Shares are the slopes of the regression of what was found.
  void update() {
    constexpr float kExpected = 0.95F, kDoubt = 0.5F;
    for (std::size_t i = 0; i < sums_.size(); ++i)
      shares_[i] =
          std::clamp((sums_[i].along + kDoubt * kExpected) / (sums_[i].squared + kDoubt), 0.0F, 1.0F);
    constexpr float kExpectedOfOne = 0.95F, kDoubtOfOne = 0.1F;  // whether it is a mirror is learned soon
    Sums one;
    for (std::size_t i = class_of(Basis::kOne, 0); i < class_of(Basis::kNothing, 0); ++i)
      one.along += sums_[i].along, one.squared += sums_[i].squared;
    of_one_ =
        std::clamp((one.along + kDoubtOfOne * kExpectedOfOne) / (one.squared + kDoubtOfOne), 0.0F, 1.0F);
    for (std::size_t level = 0; level < kErrorLevels; ++level)
      shares_[class_of(Basis::kAllAround, static_cast<int>(level))] = 1;
  }

 private:
  struct Sums {
    float along = 0, squared = 0;
  };
  static constexpr std::size_t kClasses = std::size_t{kBases} * kErrorLevels;

  static std::size_t class_of(Basis basis, int error_level) {
    return static_cast<std::size_t>(static_cast<int>(basis) * kErrorLevels + error_level);
  }

  std::array<Sums, kClasses> sums_{};
  std::array<float, kClasses> shares_{};
  float of_one_ = 1;
};

}  // namespace pprt
