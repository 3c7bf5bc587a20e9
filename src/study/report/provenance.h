// Where results come from: what a reader needs to judge and to repeat them.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pprt {

// Names and values, in the order in which they are told.
using Provenance = std::vector<std::pair<std::string, std::string>>;

// The facts of this moment and machine: date (UTC), host, CPU model, cores, load (mean of the last minute),
// operating system, and the compiler that built this program. What cannot be found out is "unknown".
Provenance provenance_of_host();

}  // namespace pprt
