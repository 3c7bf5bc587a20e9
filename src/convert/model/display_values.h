// Light as modelling programs count it, and the display values that scenes hold.
#pragma once

#include <cmath>

namespace pprt {

// Returns the display value of a share of light (IEC 61966-2-1), in [0, 1]. Not a number becomes 0.
inline double display_value(double light) {
  if (!(light > 0)) return 0;
  if (light >= 1) return 1;
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

// Returns the same without the upper bound: lamps are brighter than a picture can show.
inline double unbounded_display_value(double light) {
  return light <= 1 ? display_value(light) : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

// Returns the light of a display value.
inline double light_of(double display) {
  return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
}

}  // namespace pprt
