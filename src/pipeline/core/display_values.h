// Colours as a display shows them: channels held to [0, 1].
#pragma once

#include <algorithm>

#include "base/simd.h"
#include "base/vector.h"

namespace pprt {

// Clamps to [0, 1] without a branch. std::clamp takes references, hence branches, which noisy colours make
// slow.
inline float held_to_unit(float v) {
  const float from_below = v > 0 ? v : 0;
  return from_below < 1 ? from_below : 1;
}

// Clamps red, green and blue to [0, 1]; the last lane becomes 0. Scalar twin: held_to_unit().
inline float4 on_display(const float4& channels) {
  return min(max(channels, float4{}), float4{1, 1, 1, 0});
}

// Returns the mean over the channels of the variance of three intensities on the display scale [0, 1]. The
// variance of three numbers is a ninth of the sum of their squared differences.
inline float display_variance(const Color& a, const Color& b, const Color& c) {
  const auto channel = [](float p, float q, float r) {
    p = held_to_unit(p), q = held_to_unit(q), r = held_to_unit(r);
    return (p - q) * (p - q) + (q - r) * (q - r) + (r - p) * (r - p);
  };
  return (channel(a.x, b.x, c.x) + channel(a.y, b.y, c.y) + channel(a.z, b.z, c.z)) * (1.0f / 27);
}

// Returns the mean over the channels of the squared difference on the display scale.
inline double display_error(const Color& a, const Color& b) {
  const auto difference = [](float p, float q) {
    return static_cast<double>(std::clamp(p, 0.0f, 1.0f)) - static_cast<double>(std::clamp(q, 0.0f, 1.0f));
  };
  const Vec3d d(difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z));
  return d.dot(d) / 3;
}

}  // namespace pprt
