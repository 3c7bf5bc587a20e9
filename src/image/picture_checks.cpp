#include "image/picture_checks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pprt {

void require_encodable(const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    throw std::runtime_error(
        fmt::format("{} pixels make no picture of {}x{}", image.pixels.size(), image.width, image.height));
  }
  const auto bad = std::count_if(image.pixels.begin(), image.pixels.end(), [](const Color& c) {
    return !(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
  });
  if (bad > 0) throw std::runtime_error(fmt::format("{} pixels are not finite", bad));
}

void require_decodable_size(std::int64_t width, std::int64_t height) {
  if (width < 1 || height < 1 || width > kMaxPixels / height) {
    throw std::runtime_error(
        fmt::format("the size {}x{} is out of bounds (1 to {} pixels)", width, height, kMaxPixels));
  }
}

}  // namespace pprt
