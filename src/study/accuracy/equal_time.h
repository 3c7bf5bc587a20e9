// Pictures that take a given time.
#pragma once

#include <cstdint>
#include <optional>

#include "study/accuracy/methods.h"

namespace pprt {

// Returns the method's picture with so many samples per pixel, or nothing where it cannot make so few.
std::optional<Rendering> picture_with(double density, const Method& method, const Subject& subject,
                                      std::uint64_t seed);

// Returns the samples per pixel with which the method's picture takes so long; nothing where that is too
// short a time.
std::optional<double> density_in(double seconds, const Method& method, const Subject& subject,
                                 std::uint64_t seed);

}  // namespace pprt
