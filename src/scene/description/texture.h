// Pictures on surfaces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pprt {

using TextureIndex = std::uint32_t;  // into the scene's textures

// Display values as in a file, 255 for 1. Repeated without end in both directions.
struct Texture {
  std::string name;  // for messages
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // three a texel, rows from the top

  friend bool operator==(const Texture&, const Texture&) = default;
};

}  // namespace pprt
