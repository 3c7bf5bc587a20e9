// The cores that a process may use.
#pragma once

#include <bitset>

namespace pprt {

inline constexpr int kMostCores = 1024;  // that the system's affinity masks tell of
using CoreSet = std::bitset<kMostCores>;

// The cores of this process's affinity mask.
CoreSet own_cores();

// How many they are, at least 1.
int usable_cores();

// How many cores the host has, at least 1.
int installed_cores();

}  // namespace pprt
