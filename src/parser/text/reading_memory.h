// How much memory reading a scene may take.
#pragma once

#include <cstdint>
#include <string>

#include "scene/description/scene_description.h"

namespace pprt {

// Returns the default, bytes: an eighth of what is available. A compiled scene takes some three times as much
// as its description, and each process has one.
std::uint64_t usual_reading_memory();

// Returns what a scene's lists hold, bytes.
std::uint64_t memory_of(const SceneDescription& scene);

// Returns "the scene takes more than 512 MB of memory, ...", for an error with the place where it does.
std::string too_much_memory(std::uint64_t most);

}  // namespace pprt
