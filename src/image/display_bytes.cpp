#include "image/display_bytes.h"

#include <algorithm>

namespace pprt {

// Exact: a float times 255 plus a half fits a double.
std::uint8_t display_byte(float value) {
  constexpr double kHalf = 0.5;
  const double clamped = value > 0 ? std::min(double{value}, 1.0) : 0;
  return static_cast<std::uint8_t>(clamped * 255 + kHalf);
}

std::vector<std::uint8_t> display_bytes(const Image& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Color& pixel : image.pixels) {
    for (const float value : {pixel.x, pixel.y, pixel.z}) bytes.push_back(display_byte(value));
  }
  return bytes;
}

}  // namespace pprt
