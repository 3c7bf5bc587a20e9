// Files of glTF made of the fuzzer's bytes, by structure: each choice takes some bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pprt::fuzz {

struct GltfFiles {
  std::string document;  // JSON
  std::string numbers;   // the buffer "numbers.bin"
};

// Returns a document of which nearly everything is well formed. Counts, indices and lengths are now and then
// those at the ends of their ranges, or beyond, or of another type. Bytes that are missing count as 0.
GltfFiles gltf_files(std::span<const std::uint8_t> bytes);

}  // namespace pprt::fuzz
