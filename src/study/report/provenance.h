// Where results come from: the facts needed to judge and to repeat them.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pprt {

// Names and values in the order shown.
using Provenance = std::vector<std::pair<std::string, std::string>>;

// Returns date (UTC), host, CPU model, cores, load (mean of the last minute), operating system and the
// compiler of this program. A fact that cannot be read is "unknown".
Provenance provenance_of_host();

}  // namespace pprt
