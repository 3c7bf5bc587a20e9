#include "image/picture_checks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/counted.h"

namespace pprt {
namespace {

constexpr std::uint64_t kDecodedPixel = 20;  // bytes: as 16 bits a channel and opacity, and as float

}  // namespace

void require_encodable(const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    throw std::runtime_error(fmt::format("{} no picture of {}x{}",
                                         counted(image.pixels.size(), "pixel makes", "pixels make"),
                                         image.width, image.height));
  }
  const auto bad = std::count_if(image.pixels.begin(), image.pixels.end(), [](const Color& c) {
    return !(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
  });
  if (bad > 0) throw std::runtime_error(counted(bad, "pixel is not finite", "pixels are not finite"));
}

void require_decodable_size(std::int64_t width, std::int64_t height, std::uint64_t max_memory) {
  if (width < 1 || height < 1 || width > kMaxPixels / height) {
    throw std::runtime_error(
        fmt::format("the size {}x{} is out of bounds (1 to {} pixels)", width, height, kMaxPixels));
  }
  const std::uint64_t needed = kDecodedPixel * static_cast<std::uint64_t>(width * height);
  if (needed > max_memory) {
    throw std::runtime_error(fmt::format(
        "decoding {}x{} pixels takes {:.4g} MB of memory, and {:.4g} MB are left of "
        "what reading may take (--memory)",
        width, height, static_cast<double>(needed) * 1e-6, static_cast<double>(max_memory) * 1e-6));
  }
}

}  // namespace pprt
