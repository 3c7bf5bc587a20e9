// Times of this host.
#pragma once

#include <cstdint>

namespace pprt {

// Seconds on this host's steady clock, since some fixed moment.
double monotonic_seconds();

// CPU time of the calling thread, nanoseconds.
std::int64_t thread_cpu_ns();

}  // namespace pprt
