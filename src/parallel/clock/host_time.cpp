#include "parallel/clock/host_time.h"

#include <chrono>
#include <ctime>
#include <fstream>

namespace pprt {

double monotonic_seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

std::int64_t thread_cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

RunTimes thread_run_times() {
  RunTimes times;
  std::ifstream told("/proc/thread-self/schedstat");
  if (!(told >> times.ran_ns >> times.waited_ns)) return {};
  return times;
}

}  // namespace pprt
