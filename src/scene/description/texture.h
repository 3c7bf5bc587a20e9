// Pictures on surfaces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pprt {

using TextureIndex = std::uint32_t;  // into the scene's textures

// The name of no texture in AFF, where a mesh has texture points for its emission alone.
inline constexpr std::string_view kNoTexture = "-";

// Display values as in a file, 255 for 1. Repeated without end in both directions.
struct Texture {
  std::string name;  // for messages
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // three a texel, rows from the top

  friend bool operator==(const Texture&, const Texture&) = default;
};

}  // namespace pprt
