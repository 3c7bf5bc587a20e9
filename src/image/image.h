// A picture in memory: linear RGB, rows from the top.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vector.h"

namespace pprt {

// Pixel (x, y) is pixels[y * width + x]; (0, 0) is the upper left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Color> pixels;  // width * height, row by row

  Image() = default;
  Image(int w, int h, const Color& fill = Color(0, 0, 0))
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}

  Color& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  const Color& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

}  // namespace pprt
