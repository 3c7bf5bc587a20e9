// What may go along with a picture: named channels in an EXR, further pictures beside a PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "image/image.h"

namespace pprt {

// One plane of numbers, of the picture's size, row after row from the top. The name is "layer.channel", as
// OpenEXR has it. float4 may be infinite but not NaN; they are stored as 32 bits, as are counted things.
struct Channel {
  std::string name;
  std::variant<std::vector<float>, std::vector<std::uint32_t>> values;
};

// Made where and when they are written, so that the frame loop does not wait for them.
struct LayerMaker {
  std::vector<std::string> names;                  // of the layers; empty: none, and nothing is called
  std::function<std::vector<Channel>()> channels;  // of all layers
  // The layer as a picture of its own, of any size.
  std::function<Image(std::size_t layer, const Image& frame)> picture;
  std::size_t bytes = 0;  // that it keeps in memory
};

}  // namespace pprt
