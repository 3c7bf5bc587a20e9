#include "trace/textures/texture_image.h"

#include <algorithm>
#include <array>

namespace pprt {
namespace {

// Shares of up to three texels of a row of `from` in texel `i` of a row of `to` = max(1, from / 2) that
// covers the same. An odd row is divided evenly. The first of the three is texel 2 i.
std::array<float, 3> shares(int from, int to, int i) {
  if (from == 1) return {1, 0, 0};
  if (from == 2 * to) return {0.5F, 0.5F, 0};
  const auto whole = static_cast<float>(from);
  return {static_cast<float>(to - i) / whole, static_cast<float>(to) / whole,
          static_cast<float>(i + 1) / whole};
}

struct Plane {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

// Returns the picture at half the width and half the height, rounded down but at least 1.
template <class Value>
Plane halved(const Value* rgb, int width, int height) {
  Plane plane{std::max(1, width / 2), std::max(1, height / 2), {}};
  plane.rgb.resize(3 * static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height));
  auto next = plane.rgb.begin();
  for (int y = 0; y < plane.height; ++y) {
    const std::array<float, 3> down = shares(height, plane.height, y);
    for (int x = 0; x < plane.width; ++x) {
      const std::array<float, 3> across = shares(width, plane.width, x);
      Color sum(0, 0, 0);
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
          const float share = down[static_cast<std::size_t>(j)] * across[static_cast<std::size_t>(i)];
          if (share == 0) continue;
          const Value* texel =
              rgb + 3 * (static_cast<std::size_t>(2 * y + j) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(2 * x + i));
          sum += Color(texel[0], texel[1], texel[2]) * share;
        }
      }
      for (int k = 0; k < 3; ++k) *next++ = sum[k];
    }
  }
  return plane;
}

}  // namespace

TextureImage::TextureImage(const Texture& texture)
    : levels_{{texture.width, texture.height, 0}}, rgb_(texture.rgb) {
  if (texture.width == 1 && texture.height == 1) return;
  Plane plane = halved(texture.rgb.data(), texture.width, texture.height);
  while (true) {
    levels_.push_back({plane.width, plane.height, rgb_.size()});
    for (const float value : plane.rgb) rgb_.push_back(static_cast<std::uint8_t>(value + 0.5F));
    if (plane.width == 1 && plane.height == 1) return;
    plane = halved(plane.rgb.data(), plane.width, plane.height);
  }
}

// The filter has the variance of an even density over the footprint: diameter^2 / 12 along each axis. At a
// level with texels of size e, a bilinear value has e^2 / 4 in the mean: e^2 / 12 of the texels, e^2 / 6 of
// the interpolation. n places in a row at distances h add h^2 (n^2 - 1) / 12. They stand at most e apart.
Color TextureImage::over(const TextureFootprint& footprint, const Vec2d& point) const {
  // Squares of the axes in texels: the eigenvalues of M M^T.
  const double width = levels_.front().width, height = levels_.front().height;
  const double xx = footprint.uu * width * width, yy = footprint.vv * height * height;
  const double xy = footprint.uv * width * height;
  const double mean = (xx + yy) / 2, half = (xx - yy) / 2;
  const double radius = std::sqrt(half * half + xy * xy);
  const double longer = mean + radius, shorter = mean - radius;
  if (!(longer > 3)) return at(point);
  const double size2 = std::max({1.0, shorter / 3, longer / (kMostTaps * kMostTaps + 2)});
  if (!std::isfinite(size2)) return texel(levels_.back(), 0, 0);
  const Levels levels = levels_for(size2);

  const double missing = longer / size2 - 3;  // variance that the row must add, in e^2 / 12
  const int taps = std::min(static_cast<int>(std::ceil(std::sqrt(missing + 1))), kMostTaps);
  if (taps <= 1) return between(levels, point);
  // Direction of the longer axis: of two forms the one that does not cancel.
  const double x = half >= 0 ? half + radius : xy, y = half >= 0 ? xy : radius - half;
  const double step = std::sqrt(size2 * missing / (taps * taps - 1) / (x * x + y * y));
  const Vec2d way(x * step / width, y * step / height);
  Color sum(0, 0, 0);
  for (int i = 0; i < taps; ++i) sum += between(levels, point + way * (i - 0.5 * (taps - 1)));
  return sum * (1 / static_cast<float>(taps));
}

// Mixes variances, not logarithms of sizes, which would differ between processors.
TextureImage::Levels TextureImage::levels_for(double size2) const {
  int octave = 0;
  const double mantissa = std::frexp(std::sqrt(size2), &octave);  // 1/2 to 1; the size is >= 1
  const std::size_t last = levels_.size() - 1, finer = static_cast<std::size_t>(octave - 1);
  return {levels_[std::min(finer, last)], levels_[std::min(finer + 1, last)],
          static_cast<float>((4 * mantissa * mantissa - 1) / 3)};
}

Color TextureImage::between(const Levels& levels, const Vec2d& point) const {
  const Color color = at(levels.finer, point);
  if (!(levels.share > 0)) return color;
  return color * (1 - levels.share) + at(levels.coarser, point) * levels.share;
}

}  // namespace pprt
