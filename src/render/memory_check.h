// Whether a run's pictures fit into memory: told before it begins, not by the system when it is too late.
#pragma once

#include <cstdint>

#include "render/render_plan.h"

namespace pprt {

// Returns the least memory, in bytes, that the pictures of a run take: those that ranks reconstruct, those
// that rank 0 puts together, and the files. Samples and the scene come on top. Measured at 16384x16384 pixels
// (docs/performance.md).
std::uint64_t memory_of_pictures(const RenderPlan& plan);

// Returns the memory that this process can have, in bytes: what the system calls available, within the
// process's limit.
std::uint64_t available_memory();

// Throws std::runtime_error with both figures when the first is greater.
void require_memory(const RenderPlan& plan);

}  // namespace pprt
