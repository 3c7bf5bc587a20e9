// Pseudo-random numbers that depend on their address alone, never on the order of calls.
#pragma once

#include <cstdint>

namespace pprt {

// Mixes a word into a running hash: the output function of splitmix64 (Steele, Lea and Flood 2014).
constexpr std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) + 0x9e3779b97f4a7c15u;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
  return hash ^ (hash >> 31);
}

// Returns a multiple of 2^-53 in [0, 1). A stream is a frame, a pixel, or another sequence of its own.
constexpr double uniform(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  return static_cast<double>(mixed(mixed(seed, stream), index) >> 11) * 0x1p-53;
}

}  // namespace pprt
