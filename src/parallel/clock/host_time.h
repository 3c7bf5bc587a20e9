// Times of this host.
#pragma once

#include <cstdint>

namespace pprt {

// Seconds on this host's steady clock, since some fixed moment.
double monotonic_seconds();

// CPU time of the calling thread, nanoseconds.
std::int64_t thread_cpu_ns();

// What a thread has done since it began, nanoseconds.
struct RunTimes {
  std::int64_t ran_ns = 0;
  std::int64_t waited_ns = 0;  // it could have run, but others had its core
};

// Returns those of the calling thread, from /proc/thread-self/schedstat. 0 where the kernel does not tell.
RunTimes thread_run_times();

}  // namespace pprt
