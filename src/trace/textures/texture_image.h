// A texture prepared for shading: a pyramid of pictures, each of half the size, and filters over it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vector.h"
#include "scene/description/texture.h"

namespace pprt {

// What a sample covers of a texture: an ellipse about its point. Its conjugate diameters are the columns of a
// matrix M in texture coordinates; these are the entries of M M^T.
struct TextureFootprint {
  double uu = 0, uv = 0, vv = 0;
};

// Each level of the pyramid holds means of display values over the same areas
// (docs/decisions/0004-display-values.md), rounded once. So the mean of a level is that of the texture, up to
// half a step of 255.
class TextureImage {
 public:
  // The texture must have at least one texel.
  explicit TextureImage(const Texture& texture);

  // Returns the colour at texture coordinates, bilinear between the middles of texels. (0, 0) is the upper
  // left corner, (1, 1) the lower right; beyond, the picture repeats. Coordinates that are not finite, or
  // beyond 2^52, give some colour of the picture.
  Color at(const Vec2d& point) const { return at(levels_.front(), point); }

  // Returns the mean colour over a footprint, approximately: by at most kMostTaps places along its longer
  // axis, each bilinear in two levels. Where that axis is at most 3^(1/2) texels, which is what a bilinear
  // value takes the mean of anyhow, it is at(point).
  Color over(const TextureFootprint& footprint, const Vec2d& point) const;

  // Beyond 4.7 times its breadth, (kMostTaps^2 + 2)^(1/2) / 3^(1/2), a footprint is filtered broader than it
  // is. A choice: docs/decisions/0032-footprints.md.
  static constexpr int kMostTaps = 8;

  // Bytes of all levels.
  std::size_t bytes() const { return rgb_.size(); }

 private:
  // One picture of the pyramid.
  struct Level {
    int width, height;
    std::size_t first;  // its place in `rgb_`
  };

  // Two neighbouring texels in one direction, and the second one's share.
  struct Place {
    int first, second;
    float share;
  };

  // Two neighbouring levels, and the coarser one's share.
  struct Levels {
    Level finer, coarser;
    float share;
  };

  // `size2`: the square of a texel's size, at least 1.
  Levels levels_for(double size2) const;
  Color between(const Levels& levels, const Vec2d& point) const;

  static Place place(double coordinate, int size) {
    const double within = coordinate - std::floor(coordinate);
    const double middle = (within >= 0 ? within : 0) * size - 0.5;
    const double below = std::floor(middle);
    const auto first = static_cast<int>(below);  // from -1 to size - 1
    return {first < 0 ? size - 1 : first, first + 1 < size ? first + 1 : 0,
            static_cast<float>(middle - below)};
  }

  Color at(const Level& level, const Vec2d& point) const {
    const Place across = place(point.x, level.width), down = place(point.y, level.height);
    const Color upper = texel(level, across.first, down.first) * (1 - across.share) +
                        texel(level, across.second, down.first) * across.share;
    const Color lower = texel(level, across.first, down.second) * (1 - across.share) +
                        texel(level, across.second, down.second) * across.share;
    return upper * (1 - down.share) + lower * down.share;
  }

  Color texel(const Level& level, int x, int y) const {
    const std::uint8_t* rgb =
        &rgb_[level.first + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                                 static_cast<std::size_t>(x))];
    return Color(rgb[0], rgb[1], rgb[2]) * (1 / 255.F);
  }

  std::vector<Level> levels_;  // the texture's own picture first, a single texel last
  std::vector<std::uint8_t> rgb_;
};

}  // namespace pprt
