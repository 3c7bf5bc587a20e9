#include "layers/coverage_mask.h"

#include <algorithm>
#include <cmath>

namespace pprt {
namespace {

// A half-open range of pixels along one axis: those whose centres lie in [low, high].
struct Range {
  int begin, end;
};

Range centers_between(double low, double high, int size) {
  const double begin = std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(size));
  const double end = std::clamp(std::floor(high + 0.5), begin, static_cast<double>(size));
  return {static_cast<int>(begin), static_cast<int>(end)};
}

double distance_to_segment(const Vec2d& point, const Vec2d& from, const Vec2d& way) {
  const double length2 = way.dot(way);
  const double share = length2 > 0 ? std::clamp((point - from).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (point - from - way * share).length();
}

}  // namespace

void draw_line(CoverageMask& mask, const Vec2d& from, const Vec2d& to, double width) {
  const double reach = 0.5 * width + 0.5;
  const Vec2d way = to - from;
  const auto [left, right] = std::minmax(from.x, to.x);
  const auto [top, bottom] = std::minmax(from.y, to.y);
  const Range rows = centers_between(top - reach, bottom + reach, mask.height);
  for (int y = rows.begin; y < rows.end; ++y) {
    double low = left - reach, high = right + reach;
    if (way.y != 0) {
      const double middle = from.x + (y + 0.5 - from.y) * (way.x / way.y);
      const double spread = reach * (way.length() / std::abs(way.y));
      low = std::max(low, middle - spread), high = std::min(high, middle + spread);
    }
    const Range columns = centers_between(low, high, mask.width);
    for (int x = columns.begin; x < columns.end; ++x) {
      const double distance = distance_to_segment({x + 0.5, y + 0.5}, from, way);
      float& cover = mask.cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
                                static_cast<std::size_t>(x)];
      cover = std::max(cover, static_cast<float>(std::clamp(reach - distance, 0.0, 1.0)));
    }
  }
}

void draw_dot(CoverageMask& mask, const Vec2d& center, double diameter) {
  draw_line(mask, center, center, diameter);
}

void paint(Image& image, const CoverageMask& mask, const Color& color) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] += (color - image.pixels[i]) * mask.cover[i];
  }
}

}  // namespace pprt
