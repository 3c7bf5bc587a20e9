#include "base/system/available_memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace pprt {
namespace {

constexpr std::uint64_t kNoBound = std::numeric_limits<std::uint64_t>::max();

// Returns the kernel's estimate.
std::uint64_t of_system() {
  std::ifstream in("/proc/meminfo");
  std::uint64_t kilobytes = 0;
  for (std::string name, rest; in >> name; std::getline(in, rest)) {
    if (name != "MemAvailable:" && name != "SwapFree:") continue;
    std::uint64_t part = 0;
    in >> part;
    kilobytes += part;
  }
  return kilobytes > 0 ? 1024 * kilobytes : kNoBound;
}

std::uint64_t of_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoBound;
  return limit.rlim_cur;
}

}  // namespace

std::uint64_t available_memory() {
  return std::min(of_system(), of_process());
}

}  // namespace pprt
