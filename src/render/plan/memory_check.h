// Whether a run's pictures fit into memory: told before it begins, not by the system when it is too late.
#pragma once

#include <cstdint>

namespace pprt {

// Returns the least memory, in bytes, that the pictures of a run take: those that ranks reconstruct, those
// that rank 0 puts together, and the files. Samples and the scene come on top. Measured at 16384x16384 pixels
// (docs/performance.md).
std::uint64_t memory_of_pictures(int width, int height, bool has_rate);

// Throws std::runtime_error with both figures when that is more than available_memory().
void require_memory(int width, int height, bool has_rate);

}  // namespace pprt
