// Shading rules that NFF leaves to its reader: brightness of lights, ambient light, visible highlights.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scene/description/scene_description.h"

namespace pprt {

// Ambient reflectance of every material, as in SPD's own reader; NFF has no parameter for it.
inline constexpr double kAmbientReflectance = 0.1;

// Returns the weight of each light and of the ambient light: sqrt(n) / (2 n) for n lights, as Haines
// recommends.
inline double light_weight(std::size_t lights) {
  return 0.5 / std::sqrt(static_cast<double>(std::max<std::size_t>(lights, 1)));
}

// Phong exponent from which on no highlight is drawn. It would be narrower than half a degree and only
// flicker. SPD writes 100000 for "none".
inline constexpr double kNoHighlightShine = 1e5;

// Returns whether a material's highlight is drawn at all.
inline bool has_highlight(const Material& material) {
  return material.specular > 0 && material.shine > 0 && material.shine < kNoHighlightShine;
}

// Returns the index used for refraction. The material's own is meaningless (often 0) when it is opaque.
inline double effective_refractive_index(const Material& material) {
  return material.refractive_index > 0 ? material.refractive_index : 1;
}

}  // namespace pprt
