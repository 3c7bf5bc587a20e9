// Display values as bytes: the only place where a picture is quantised to 256 levels.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace pprt {

// Returns round(255 v), v clamped to [0, 1], halves rounded up; 0 for NaN.
std::uint8_t display_byte(float value);

// Returns red, green and blue of every pixel, 3 bytes a pixel, row after row: what a PNG shows.
std::vector<std::uint8_t> display_bytes(const Image& image);

}  // namespace pprt
