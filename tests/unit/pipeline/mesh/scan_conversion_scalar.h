// Scalar twins of scan_conversion.h and TriangleRasteriser::fill(): one number at a time, in the same order
// of operations, so both are equal to the bit. They stand here to be read beside the vector routines; only
// the tests that compare them call them.
#pragma once

#include <algorithm>
#include <array>

#include "base/vector.h"
#include "pipeline/core/tile_grid.h"
#include "pipeline/mesh/scan_conversion.h"

namespace pprt::scalar {

using Corners = std::array<ScreenCorner, 3>;

inline float sum(const std::array<float, kLines>& v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}

// The pixels [left, last] of a row whose centres a triangle holds; none where last < left.
struct Span {
  int left = 0, last = -1;
};

// Scalar twin of spans_at(): one row.
inline Span span_at(const Outline& outline, int row, const PixelRect& bounds) {
  const double center = row + 0.5;
  if (row < bounds.y0 || row >= bounds.y1 || center < outline.top() || center >= outline.bottom()) return {};
  const Extent extent = outline.at(center);
  return {std::max(first_center(extent.left), bounds.x0),
          std::min(first_center(extent.right), bounds.x1) - 1};
}

// Barycentric coordinates as linear functions of an offset from the first corner.
struct Barycentric {
  explicit Barycentric(const Corners& c) {
    const double x1 = c[1].x - c[0].x, y1 = c[1].y - c[0].y;
    const double x2 = c[2].x - c[0].x, y2 = c[2].y - c[0].y;
    const double cross = x1 * y2 - y1 * x2;
    const double scale = cross != 0 ? 1 / cross : 0;
    ax = y2 * scale, ay = -x2 * scale, bx = -y1 * scale, by = x1 * scale;
  }

  double ax, ay, bx, by;
};

inline Color color_of(const ScreenCorner& corner) {
  return {corner.color[0], corner.color[1], corner.color[2]};
}

// Scalar twin of LinearPatch::at_centers(): row number `i` of the four that begin with `first_row`.
inline Color color_at_center(const Corners& c, int column, int first_row, int i) {
  const Barycentric f(c);
  const double dx = column + (0.5 - c[0].x), dy = (0.5 + i) + (first_row - c[0].y);
  const auto share = [&](double per_x, double per_y) {
    return max(0.0F, min(static_cast<float>(per_x * dx + per_y * dy), 1.0F));
  };
  const float a = share(f.ax, f.ay), b = share(f.bx, f.by);
  return color_of(c[0]) + (color_of(c[1]) - color_of(c[0])) * a + (color_of(c[2]) - color_of(c[0])) * b;
}

// Scalar twin of TriangleRasteriser::fill() with NoSilhouette: one row. Calls set(column, color).
template <class Set>
void fill_span(const Corners& corners, int first_row, int i, const Span& span, const Set& set) {
  if (span.last < span.left) return;
  const int steps = span.last - span.left;
  const Color first = color_at_center(corners, span.left, first_row, i);
  const Color last = color_at_center(corners, span.last, first_row, i);
  const Color step = (last - first) * (1 / static_cast<float>(std::max(steps, 1)));
  for (int x = 0; x <= steps; ++x) set(span.left + x, first + step * static_cast<float>(x));
}

// Scalar twin of Outline::along(): one line of a pixel row, in pixels from `column`.
inline std::array<float, 2> extent_on_line(const Outline& outline, int row, int column, int line) {
  const double y = static_cast<double>(kLineOffsets[line]) + row;
  const bool meets = y >= outline.top() && y < outline.bottom();
  const Extent extent = meets ? outline.at(y) : Extent{0, 0};
  return {static_cast<float>(extent.left - column), static_cast<float>(extent.right - column)};
}

// A triangle's part of one line in one pixel, as LineParts.
struct LinePart {
  float from, to, length;
};

// Scalar twin of parts_in_pixel(): one line.
inline LinePart part_in_pixel(const std::array<float, 2>& extent, int column) {
  const auto begin = static_cast<float>(column);
  const float from = max(extent[0], begin), to = min(extent[1], begin + 1);
  return {from, to, max(to - from, 0.0F) * (1.0F / kLines)};
}

// Scalar twin of LinearPatch::OnLines::integral(): the parts of all lines about their middles.
inline Color integral_on_lines(const Corners& c, int row, int column,
                               const std::array<LinePart, kLines>& parts, const Color& base) {
  const Barycentric f(c);
  const double dx = column - c[0].x, dy = row - c[0].y;
  std::array<float, kLines> length{}, a{}, b{};
  for (int line = 0; line < kLines; ++line) {
    const auto i = static_cast<std::size_t>(line);
    const float middle = 0.5F * (parts[i].from + parts[i].to);
    const auto share = [&](double per_x, double per_y) {
      const float at_column =
          static_cast<float>(per_x * dx + per_y * dy) + static_cast<float>(per_y) * kLineOffsets[line];
      const float v = at_column + static_cast<float>(per_x) * middle;
      return max(0.0F, min(v, 1.0F)) * parts[i].length;
    };
    length[i] = parts[i].length, a[i] = share(f.ax, f.ay), b[i] = share(f.bx, f.by);
  }
  return (color_of(c[0]) - base) * sum(length) + (color_of(c[1]) - color_of(c[0])) * sum(a) +
         (color_of(c[2]) - color_of(c[0])) * sum(b);
}

}  // namespace pprt::scalar
