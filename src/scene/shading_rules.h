// What NFF leaves to its reader: how bright lights are, what lies in the dark, which highlights are drawn.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scene/scene_description.h"

namespace pprt {

// SPD's own reader gives every material this ambient reflectance; NFF has no word for it.
inline constexpr double kAmbientReflectance = 0.1;

// Haines' recommendation for each light and for the ambient light: sqrt(n) / (2 n) with n lights.
inline double light_weight(std::size_t lights) {
  return 0.5 / std::sqrt(static_cast<double>(std::max<std::size_t>(lights, 1)));
}

// An exponent from which on a Phong highlight is narrower than half a degree: it would only sparkle. SPD
// writes 100000 for "none".
inline constexpr double kNoHighlightShine = 1e5;

// Whether a material's highlight is drawn at all.
inline bool has_highlight(const Material& material) {
  return material.specular > 0 && material.shine > 0 && material.shine < kNoHighlightShine;
}

// What refraction takes for a material's index, which is meaningless (often 0) on opaque ones.
inline double effective_refractive_index(const Material& material) {
  return material.refractive_index > 0 ? material.refractive_index : 1;
}

}  // namespace pprt
