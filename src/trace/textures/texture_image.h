// A texture prepared for shading: a pyramid of pictures, each of half the size, and filters over it.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/simd.h"
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
  Color at(const Vec2d& point) const { return color_of(lanes_at(levels_.front(), point)); }

  // Returns the mean colour over a footprint, approximately: by at most kMostTaps places along its longer
  // axis, each bilinear in two levels. Where the texture resolves it, it is at(point).
  Color over(const TextureFootprint& footprint, const Vec2d& point) const;

  // Whether a footprint's longer axis is at most 3^(1/2) texels, which is what a bilinear value takes the
  // mean of anyhow.
  bool resolves(const TextureFootprint& footprint) const { return !(axes_of(footprint).longer > kResolved); }

  // Squares of the image as they lie on the picture, per_side x per_side of them: a power of two, at least 2.
  // Steps lead from the middle to each square. They shrink by 1 + steps * recession.
  struct Squares {
    int per_side;
    Vec2d middle, per_x, per_y;
    double recession_x, recession_y;
  };

  // Returns the mean of the bilinear colours in the middles of squares. Those whose steps shrink to less than
  // kNearestHorizon lie at the horizon or behind it, and do not count.
  Color mean(const Squares& squares) const;

  static constexpr double kNearestHorizon = 1e-6;

  // Beyond 4.7 times its breadth, (kMostTaps^2 + 2)^(1/2) / 3^(1/2), a footprint is filtered broader than it
  // is. A choice: docs/decisions/0032-footprints.md.
  static constexpr int kMostTaps = 8;

  // Bytes of all levels.
  std::size_t bytes() const { return texels_.size() * sizeof texels_[0]; }

 private:
  // Red, green, blue and 0.
  using Lanes = float4;
  static Color color_of(const Lanes& lanes) { return {lanes[0], lanes[1], lanes[2]}; }

  // One picture of the pyramid.
  struct Level {
    int width, height;
    std::size_t first;  // its place in `texels_`
  };

  // Two neighbouring levels, and the coarser one's share.
  struct Levels {
    Level finer, coarser;
    float share;
  };

  // Squares of a footprint's axes in texels, the eigenvalues of M M^T, and the way of the longer one.
  struct Axes {
    double longer, shorter;
    Vec2d way;
  };
  static constexpr double kResolved = 3;  // square of an axis, texels
  Axes axes_of(const TextureFootprint& footprint) const;

  // Two neighbouring texels in one direction, and the second one's share.
  struct Place {
    int first, second;
    float share;
  };

  // `size2`: the square of a texel's size, at least 1.
  Levels levels_for(double size2) const;

  static Place place(double coordinate, int size) {
    const double within = coordinate - std::floor(coordinate);
    const double middle = (within >= 0 ? within : 0) * size - 0.5;
    const double below = std::floor(middle);
    const auto first = static_cast<int>(below);  // from -1 to size - 1
    return {first < 0 ? size - 1 : first, first + 1 < size ? first + 1 : 0,
            static_cast<float>(middle - below)};
  }

  struct FourPlaces {
    std::array<std::int32_t, kLanes> first, second;
    std::array<float, kLanes> share;
  };
  static FourPlaces places(const double4& coordinates, int size);
  Lanes sum_of_four(const double4& u, const double4& v) const;

  Lanes lanes_at(const Level& level, const Vec2d& point) const {
    return lanes_at(level, place(point.x, level.width), place(point.y, level.height));
  }
  Lanes lanes_at(const Level& level, const Place& across, const Place& down) const {
    const Lanes upper = texel(level, across.first, down.first) * (1 - across.share) +
                        texel(level, across.second, down.first) * across.share;
    const Lanes lower = texel(level, across.first, down.second) * (1 - across.share) +
                        texel(level, across.second, down.second) * across.share;
    return upper * (1 - down.share) + lower * down.share;
  }

  Lanes between(const Levels& levels, const Vec2d& point) const {
    const Lanes color = lanes_at(levels.finer, point);
    if (!(levels.share > 0)) return color;
    return color * (1 - levels.share) + lanes_at(levels.coarser, point) * levels.share;
  }

  Lanes texel(const Level& level, int x, int y) const {
    const Texel& found =
        texels_[level.first + static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                static_cast<std::size_t>(x)];
    return numbers_of(found) * (1 / 255.F);
  }

  // Red, green, blue and 0, so that all are read at once.
  using Texel = std::array<std::uint8_t, 4>;
  template <class Value>
  void append(const Value* rgb, std::size_t count);

  std::vector<Level> levels_;  // the texture's own picture first, a single texel last
  std::vector<Texel> texels_;
};

}  // namespace pprt
