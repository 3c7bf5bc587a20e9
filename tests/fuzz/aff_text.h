// Scenes of AFF made of the fuzzer's bytes, by structure: each choice of the format takes a byte.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pprt::fuzz {

// Returns a scene of which nearly every directive is well formed. Its counts, indices and numbers are often
// those at the ends of their ranges, and sometimes beyond. Bytes that are missing count as 0.
std::string aff_text(std::span<const std::uint8_t> bytes);

}  // namespace pprt::fuzz
