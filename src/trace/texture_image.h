// A texture prepared for shading.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "scene/description/texture.h"

namespace pprt {

class TextureImage {
 public:
  // The texture must have at least one texel.
  explicit TextureImage(const Texture& texture)
      : width_(texture.width), height_(texture.height), rgb_(texture.rgb) {}

  // Returns the colour at texture coordinates, bilinear between the middles of texels. (0, 0) is the upper
  // left corner, (1, 1) the lower right; beyond, the picture repeats. Coordinates that are not finite, or
  // beyond 2^52, give some colour of the picture.
  Color at(const Vec2d& point) const {
    const Place across = place(point.x, width_), down = place(point.y, height_);
    const Color upper = texel(across.first, down.first) * (1 - across.share) +
                        texel(across.second, down.first) * across.share;
    const Color lower = texel(across.first, down.second) * (1 - across.share) +
                        texel(across.second, down.second) * across.share;
    return upper * (1 - down.share) + lower * down.share;
  }

 private:
  // Two neighbouring texels in one direction, and the second one's share.
  struct Place {
    int first, second;
    float share;
  };

  static Place place(double coordinate, int size) {
    const double within = coordinate - std::floor(coordinate);
    const double middle = (within >= 0 ? within : 0) * size - 0.5;
    const double below = std::floor(middle);
    const auto first = static_cast<int>(below);  // from -1 to size - 1
    return {first < 0 ? size - 1 : first, first + 1 < size ? first + 1 : 0,
            static_cast<float>(middle - below)};
  }

  Color texel(int x, int y) const {
    const std::uint8_t* rgb = &rgb_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                         static_cast<std::size_t>(x))];
    return Color(rgb[0], rgb[1], rgb[2]) * (1 / 255.F);
  }

  int width_, height_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace pprt
