#include "render/plan/memory_check.h"

#include <fmt/core.h>

#include <stdexcept>

#include "base/system/available_memory.h"

namespace pprt {

std::uint64_t memory_of_pictures(int width, int height, bool has_rate) {
  constexpr std::uint64_t kPicture = 12;  // bytes a pixel
  constexpr std::uint64_t kEncoded = 3;   // as a file
  // What the ranks reconstruct, and what rank 0 puts together of it. With a rate it also keeps the frame
  // before, and the order for the next frame is out already.
  const std::uint64_t pictures = has_rate ? 4 : 2;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  return pixels * (pictures * kPicture + kEncoded);
}

void require_memory(int width, int height, bool has_rate) {
  constexpr double kGigabyte = 1e9;
  const std::uint64_t needed = memory_of_pictures(width, height, has_rate), available = available_memory();
  if (needed <= available) return;
  throw std::runtime_error(fmt::format(
      "pictures of {}x{} pixels take at least {:.1f} GB of memory; {:.1f} GB are available", width, height,
      static_cast<double>(needed) / kGigabyte, static_cast<double>(available) / kGigabyte));
}

}  // namespace pprt
