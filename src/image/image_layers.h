// Additional data of a picture: named channels in an EXR, further pictures beside a PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "image/image.h"

namespace pprt {

// One plane of numbers with the picture's size, row by row from the top. The name is "layer.channel", as
// OpenEXR has it. Values have 32 bits; floats may be infinite but not NaN.
struct Channel {
  std::string name;
  std::variant<std::vector<float>, std::vector<std::uint32_t>> values;
};

// Computes layers when and where they are written, so that the frame loop does not wait for them.
struct LayerMaker {
  std::vector<std::string> names;  // of the layers; empty: no layers, and nothing below is called
  std::function<std::vector<Channel>()> channels;  // returns the channels of all layers
  // Returns a layer as a picture of any size.
  std::function<Image(std::size_t layer, const Image& frame)> picture;
  std::size_t bytes = 0;  // memory that it holds
};

}  // namespace pprt
