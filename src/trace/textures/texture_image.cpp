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

// Rounds down numbers that an int holds.
double4 rounded_down(const double4& x) {
  const double4 whole = __builtin_convertvector(__builtin_convertvector(x, int4), double4);
  return whole > x ? whole - 1 : whole;
}

}  // namespace

// place() of four coordinates that an int holds; of others it is some place of the picture.
inline TextureImage::FourPlaces TextureImage::places(const double4& coordinates, int size) {
  const double4 middle = (coordinates - rounded_down(coordinates)) * size - 0.5;
  const double4 below = rounded_down(middle);
  const int4 last = int4{} + (size - 1);
  const int4 first = max(min(__builtin_convertvector(below, int4), last), int4{} - 1);
  FourPlaces found;
  store(first < 0 ? last : first, found.first.data());
  store(first < last ? first + 1 : int4{}, found.second.data());
  store(__builtin_convertvector(middle - below, float4), found.share.data());
  return found;
}

// Returns the sum of the colours at four places of the finest level.
inline TextureImage::Lanes TextureImage::sum_of_four(const double4& u, const double4& v) const {
  const Level& finest = levels_.front();
  const FourPlaces across = places(u, finest.width), down = places(v, finest.height);
  Lanes sum{};
  for (std::size_t k = 0; k < std::size_t{kLanes}; ++k)
    sum += lanes_at(finest, {across.first[k], across.second[k], across.share[k]},
                    {down.first[k], down.second[k], down.share[k]});
  return sum;
}

TextureImage::TextureImage(const Texture& texture) : levels_{{texture.width, texture.height, 0}} {
  append(texture.rgb.data(), texture.rgb.size() / 3);
  if (texture.width == 1 && texture.height == 1) return;
  Plane plane = halved(texture.rgb.data(), texture.width, texture.height);
  while (true) {
    levels_.push_back({plane.width, plane.height, texels_.size()});
    append(plane.rgb.data(), plane.rgb.size() / 3);
    if (plane.width == 1 && plane.height == 1) return;
    plane = halved(plane.rgb.data(), plane.width, plane.height);
  }
}

template <class Value>
void TextureImage::append(const Value* rgb, std::size_t count) {
  const auto rounded = [](Value value) {
    return static_cast<std::uint8_t>(static_cast<float>(value) + 0.5F);
  };
  for (; count > 0; --count, rgb += 3)
    texels_.push_back({rounded(rgb[0]), rounded(rgb[1]), rounded(rgb[2]), 0});
}

TextureImage::Axes TextureImage::axes_of(const TextureFootprint& footprint) const {
  const double width = levels_.front().width, height = levels_.front().height;
  const double xx = footprint.uu * width * width, yy = footprint.vv * height * height;
  const double xy = footprint.uv * width * height;
  const double mean = (xx + yy) / 2, half = (xx - yy) / 2;
  const double radius = std::sqrt(half * half + xy * xy);
  // Direction of the longer axis: of two forms the one that does not cancel.
  const Vec2d way = half >= 0 ? Vec2d(half + radius, xy) : Vec2d(xy, radius - half);
  return {mean + radius, mean - radius, way};
}

// The filter has the variance of an even density over the footprint: diameter^2 / 12 along each axis. At a
// level with texels of size e, a bilinear value has e^2 / 4 in the mean: e^2 / 12 of the texels, e^2 / 6 of
// the interpolation. n places in a row at distances h add h^2 (n^2 - 1) / 12. They stand at most e apart.
PPRT_CLONED_FOR_WIDE_REGISTERS Color TextureImage::over(const TextureFootprint& footprint,
                                                        const Vec2d& point) const {
  const auto& [longer, shorter, direction] = axes_of(footprint);
  if (!(longer > kResolved)) return at(point);
  const double size2 = std::max({1.0, shorter / 3, longer / (kMostTaps * kMostTaps + 2)});
  if (!std::isfinite(size2)) return color_of(texel(levels_.back(), 0, 0));
  const Levels levels = levels_for(size2);

  const double missing = longer / size2 - 3;  // variance that the row must add, in e^2 / 12
  const int taps = std::min(static_cast<int>(std::ceil(std::sqrt(missing + 1))), kMostTaps);
  if (taps <= 1) return color_of(between(levels, point));
  const double step = std::sqrt(size2 * missing / (taps * taps - 1) / direction.dot(direction));
  const Vec2d way(direction.x * step / levels_.front().width, direction.y * step / levels_.front().height);
  Lanes sum{};
  for (int i = 0; i < taps; ++i) sum += between(levels, point + way * (i - 0.5 * (taps - 1)));
  return color_of(sum * (1 / static_cast<float>(taps)));
}

// Two by two places at once.
PPRT_CLONED_FOR_WIDE_REGISTERS Color TextureImage::mean(const Squares& squares) const {
  constexpr double4 kAcross = {0, 1, 0, 1}, kDown = {0, 0, 1, 1};
  const int n = squares.per_side;
  const double first = -0.5 * (n - 1);
  const Vec2d middle(squares.middle.x - std::floor(squares.middle.x),
                     squares.middle.y - std::floor(squares.middle.y));
  Lanes sum{};
  int seen = 0;
  for (int y = 0; y < n; y += 2) {
    const double4 dy = kDown + (first + y);
    for (int x = 0; x < n; x += 2) {
      const double4 dx = kAcross + (first + x);
      const double4 nearer = 1 + squares.recession_x * dx + squares.recession_y * dy, each = 1 / nearer;
      const double4 u = middle.x + (squares.per_x.x * dx + squares.per_y.x * dy) * each;
      const double4 v = middle.y + (squares.per_x.y * dx + squares.per_y.y * dy) * each;
      if (!any(__builtin_convertvector(nearer <= kNearestHorizon, int4))) {
        sum += sum_of_four(u, v);
        seen += kLanes;
        continue;
      }
      for (int k = 0; k < kLanes; ++k) {
        if (!(nearer[k] > kNearestHorizon)) continue;
        sum += lanes_at(levels_.front(), {u[k], v[k]});
        ++seen;
      }
    }
  }
  return color_of(sum * (1 / static_cast<float>(std::max(seen, 1))));
}

// Mixes variances, not logarithms of sizes, which would differ between processors.
TextureImage::Levels TextureImage::levels_for(double size2) const {
  int octave = 0;
  const double mantissa = std::frexp(std::sqrt(size2), &octave);  // 1/2 to 1; the size is >= 1
  const std::size_t last = levels_.size() - 1, finer = static_cast<std::size_t>(octave - 1);
  return {levels_[std::min(finer, last)], levels_[std::min(finer + 1, last)],
          static_cast<float>((4 * mantissa * mantissa - 1) / 3)};
}

}  // namespace pprt
