// How much memory a process can have.
#pragma once

#include <cstdint>

namespace pprt {

// Returns bytes: what the system calls available, swap included, within the process's own limit. Without
// either, the largest number.
std::uint64_t available_memory();

}  // namespace pprt
