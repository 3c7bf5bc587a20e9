// What samples cast from frames before know of the light near image points. Shadow rays are most of the rays
// of many scenes, and lights and shadows rest while the camera moves. So a sample near a cast one on the same
// primitive takes over which lights are seen there. Where it is and how it is shaded is computed anew:
// geometry is exact, highlights are too, and the borders of shadows err by the distance of the two at most.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/sample.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

class CarriedLights {
 public:
  // How far a sample may lie from the point that takes over its lights, pixels.
  static constexpr float kReach = 0.5F;

  void clear() { samples_.clear(); }

  // Takes in the samples cast into a rectangle of the image, in the place of those before. Others are left
  // out.
  void take(std::span<const Sample> samples, const PixelRect& bounds);

  // Returns what is known at an image point, pixels: of each primitive the nearest sample's lights, of four
  // primitives at most. Valid until the next call.
  std::span<const KnownLights> near(const Vec2d& point);

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Carried {
    float x, y;  // pixels
    KnownLights known;
    std::uint32_t next;  // in the same pixel, or kNone
  };

  PixelRect bounds_;
  std::vector<Carried> samples_;
  std::vector<std::uint32_t> first_;  // per pixel of the bounds
  std::array<KnownLights, 4> found_;
  std::array<float, 4> distances_{};  // squared
};

}  // namespace pprt
