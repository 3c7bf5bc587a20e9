// Scan conversion: where a triangle meets pixel rows, and its interpolation there. Private to the pipeline.
// Scalar twins that are not in this file: scan_conversion_scalar.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/simd.h"
#include "base/vector.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

// A triangle's corner as it is drawn.
struct ScreenCorner {
  double x, y;   // image point, pixels
  float4 color;  // red, green, blue and 0
};

// Round down and up to a whole number, without the call that std::floor is on the baseline instruction set.
inline int floor_to_int(double v) {
  const int towards_zero = static_cast<int>(v);
  return towards_zero - (v < towards_zero ? 1 : 0);
}
inline int ceil_to_int(double v) {
  const int towards_zero = static_cast<int>(v);
  return towards_zero + (v > towards_zero ? 1 : 0);
}

// Returns the first pixel whose centre is at or beyond a coordinate. Scalar twin of first_centers().
inline int first_center(double coordinate) {
  return ceil_to_int(coordinate - 0.5);
}

// The mean over a pixel's area is computed from this many lines of its row, all at once. Along a line it is
// exact.
inline constexpr int kLines = kLanes;
using PerLine = float4;
inline constexpr float4 kLineOffsets = {0.125F, 0.375F, 0.625F, 0.875F};  // from the row's beginning
inline constexpr double4 kCenterOffsets = {0.5, 1.5, 2.5, 3.5};           // of four rows, from the first's

inline float sum(const float4& v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}
inline float4 on_all(float value) {
  return float4{} + value;
}

// Where a triangle lies along a line, four lines in float, or four rows in double. Pixels.
struct Extent {
  double left, right;
};
struct ExtentPerLine {
  PerLine left, right;
};
struct ExactExtents {
  double4 left, right;
};

// Returns first_center() of four coordinates.
inline int4 first_centers(const double4& coordinates) {
  const double4 v = coordinates - 0.5;
  const int4 towards_zero = __builtin_convertvector(v, int4);
  const auto is_above = v > __builtin_convertvector(towards_zero, double4);  // -1 where it is
  return towards_zero - __builtin_convertvector(is_above, int4);
}

// The parts of a row's lines that a triangle has in one pixel.
struct LineParts {
  PerLine from, to;  // pixels from the column that the extents count from
  PerLine length;    // shares of the pixel's area
};

// `column` counts from the same column as the extents.
inline LineParts parts_in_pixel(const ExtentPerLine& extents, int column) {
  const auto begin = static_cast<float>(column);
  const PerLine from = max(extents.left, on_all(begin)), to = min(extents.right, on_all(begin + 1));
  return {from, to, max(to - from, PerLine{}) * (1.0f / kLines)};
}

// A triangle's left and right end as functions of y. Each edge is evaluated from its upper end, so both
// triangles at an edge compute the same crossings to the bit: they neither overlap nor leave gaps.
class Outline {
 public:
  explicit Outline(const std::array<ScreenCorner, 3>& corner) {
    // Sorts without a branch, for corners come in any order. Of two on one level either may be the upper: the
    // edge between them is never evaluated. Orders 3 and 4 cannot occur.
    static constexpr std::array<std::array<std::uint8_t, 3>, 8> kDownwards = {
        {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    const unsigned order = static_cast<unsigned>(corner[1].y < corner[0].y) |
                           static_cast<unsigned>(corner[2].y < corner[1].y) << 1 |
                           static_cast<unsigned>(corner[2].y < corner[0].y) << 2;
    const auto& [top, middle, bottom] = kDownwards[order];
    top_ = corner[top], middle_ = corner[middle], bottom_ = corner[bottom];
    left_ = std::min({top_.x, middle_.x, bottom_.x});
    right_ = std::max({top_.x, middle_.x, bottom_.x});
  }

  double top() const { return top_.y; }
  double bottom() const { return bottom_.y; }
  double left() const { return left_; }
  double right() const { return right_; }

  // Computes the slopes. To be called before the first at(), once the triangle is known to be drawn.
  void prepare() {
    whole_ = slope(top_, bottom_);
    upper_ = slope(top_, middle_);
    lower_ = slope(middle_, bottom_);
  }

  // Needs top() <= y < bottom(). Scalar twin of the next.
  Extent at(double y) const {
    const double a = top_.x + (y - top_.y) * whole_;
    const double b = y < middle_.y ? top_.x + (y - top_.y) * upper_ : middle_.x + (y - middle_.y) * lower_;
    return {std::min(a, b), std::max(a, b)};
  }

  // At four levels; of no length where a level misses the triangle.
  ExactExtents at(const double4& y) const {
    const double4 below_top = y - top_.y;
    const double4 a = top_.x + below_top * whole_;
    const double4 b = y < middle_.y ? top_.x + below_top * upper_ : middle_.x + (y - middle_.y) * lower_;
    const auto meets = (y >= top_.y) & (y < bottom_.y);
    return {meets ? min(a, b) : double4{}, meets ? max(a, b) : double4{}};
  }

  // Along the lines of a pixel row, in pixels from `column`: near the triangle, so that float has digits to
  // spare.
  ExtentPerLine along(int row, int column) const {
    const ExactExtents exact = at(__builtin_convertvector(kLineOffsets, double4) + row);
    const auto from_column = [&](const double4& x) { return __builtin_convertvector(x - column, PerLine); };
    return {from_column(exact.left), from_column(exact.right)};
  }

 private:
  struct End {
    double x = 0, y = 0;
    End() = default;
    End(const ScreenCorner& corner) : x(corner.x), y(corner.y) {}
  };

  // The slope of a horizontal edge is never used.
  static double slope(const End& from, const End& to) { return (to.x - from.x) / (to.y - from.y); }

  End top_, middle_, bottom_;
  double left_, right_;
  double whole_ = 0, upper_ = 0, lower_ = 0;
};

// Interpolates linearly over one triangle: colour = c0 + a (c1 - c0) + b (c2 - c0), with barycentric a and b
// clamped to [0, 1]. So a constant stays exactly constant, and in slivers rounding leaves the corners' range
// by no more than itself.
class LinearPatch {
 public:
  explicit LinearPatch(const std::array<ScreenCorner, 3>& corner)
      : origin_(corner[0]),
        to_1_(corner[1].color - corner[0].color),
        to_2_(corner[2].color - corner[0].color) {
    const double x1 = corner[1].x - origin_.x, y1 = corner[1].y - origin_.y;
    const double x2 = corner[2].x - origin_.x, y2 = corner[2].y - origin_.y;
    const double cross = x1 * y2 - y1 * x2;
    const double scale = cross != 0 ? 1 / cross : 0;
    ax_ = y2 * scale, ay_ = -x2 * scale;
    bx_ = -y1 * scale, by_ = x1 * scale;
  }

  // Returns red, green and blue at the centres of a pixel in each of four rows.
  // Scalar twin: color_at_center().
  std::array<float4, 3> at_centers(const int4& column, int first_row) const {
    const double4 dx = __builtin_convertvector(column, double4) + (0.5 - origin_.x);
    const double4 dy = kCenterOffsets + (first_row - origin_.y);
    const auto share = [&](double per_x, double per_y) {
      const float4 v = __builtin_convertvector(per_x * dx + per_y * dy, float4);
      return max(float4{}, min(v, on_all(1)));
    };
    const float4 a = share(ax_, ay_), b = share(bx_, by_);
    const auto channel = [&](int i) { return origin_.color[i] + to_1_[i] * a + to_2_[i] * b; };
    return {channel(0), channel(1), channel(2)};
  }

  // The same along the lines of a pixel row, in pixels from a column.
  class OnLines {
   public:
    OnLines(const LinearPatch& patch, int row, int column) : patch_(patch) {
      const double dx = column - patch.origin_.x, dy = row - patch.origin_.y;
      a_ = static_cast<float>(patch.ax_ * dx + patch.ay_ * dy) + static_cast<float>(patch.ay_) * kLineOffsets;
      b_ = static_cast<float>(patch.bx_ * dx + patch.by_ * dy) + static_cast<float>(patch.by_) * kLineOffsets;
    }

    // Returns the integral of the colour's difference from `base` over parts of the lines: x are their
    // middles. Scalar twin: integral_on_lines().
    float4 integral(const PerLine& x, const PerLine& length, const float4& base) const {
      const auto share = [&](const PerLine& at_column, double slope) {
        const PerLine v = at_column + static_cast<float>(slope) * x;
        return sum(max(PerLine{}, min(v, on_all(1))) * length);
      };
      return (patch_.origin_.color - base) * sum(length) + patch_.to_1_ * share(a_, patch_.ax_) +
             patch_.to_2_ * share(b_, patch_.bx_);
    }

   private:
    const LinearPatch& patch_;
    PerLine a_, b_;  // barycentric, at the column
  };

 private:
  ScreenCorner origin_;
  float4 to_1_, to_2_;
  double ax_, ay_, bx_, by_;
};

// The pixels whose centres a triangle holds in four rows. A row has none where last < left.
struct Spans {
  int4 left, last;
};

// Scalar twin: span_at().
inline Spans spans_at(const Outline& outline, int first_row, const PixelRect& bounds) {
  const ExactExtents extents = outline.at(kCenterOffsets + first_row);
  const int4 row = int4{0, 1, 2, 3} + first_row;
  const int4 last = min(first_centers(extents.right), int4{} + bounds.x1) - 1;
  const auto is_inside = (row >= bounds.y0) & (row < bounds.y1);
  return {max(first_centers(extents.left), int4{} + bounds.x0), is_inside ? last : int4{} - 1};
}

}  // namespace pprt
