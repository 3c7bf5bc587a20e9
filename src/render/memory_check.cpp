#include "render/memory_check.h"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

namespace pprt {
namespace {

// Returns an entry of /proc/meminfo in bytes; 0 where there is none.
std::uint64_t meminfo(const std::string& name) {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word) {
    if (word != name + ":") continue;
    std::uint64_t kilobytes = 0;
    file >> kilobytes;
    return 1024 * kilobytes;
  }
  return 0;
}

}  // namespace

std::uint64_t memory_of_pictures(const RenderPlan& plan) {
  constexpr std::uint64_t kPicture = 12;  // bytes a pixel
  constexpr std::uint64_t kEncoded = 3;   // as a file
  // What the ranks reconstruct, and what rank 0 puts together of it. With a rate it also keeps the frame
  // before, and the order for the next frame is out already.
  const std::uint64_t pictures = plan.settings.frames_per_second > 0 ? 4 : 2;
  const auto pixels =
      static_cast<std::uint64_t>(plan.settings.width) * static_cast<std::uint64_t>(plan.settings.height);
  return pixels * (pictures * kPicture + kEncoded);
}

std::uint64_t available_memory() {
  const std::uint64_t free = meminfo("MemAvailable") + meminfo("SwapFree");
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0) limit.rlim_cur = RLIM_INFINITY;
  const std::uint64_t most =
      limit.rlim_cur == RLIM_INFINITY ? std::numeric_limits<std::uint64_t>::max() : limit.rlim_cur;
  return std::min(free > 0 ? free : most, most);
}

void require_memory(const RenderPlan& plan) {
  constexpr double kGigabyte = 1e9;
  const std::uint64_t needed = memory_of_pictures(plan), available = available_memory();
  if (needed <= available) return;
  throw std::runtime_error(
      fmt::format("pictures of {}x{} pixels take at least {:.1f} GB of memory; {:.1f} GB are available",
                  plan.settings.width, plan.settings.height, static_cast<double>(needed) / kGigabyte,
                  static_cast<double>(available) / kGigabyte));
}

}  // namespace pprt
