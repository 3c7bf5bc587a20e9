// A primitive projected to the image: the image points it covers, and how near it is at each of them.
// Reconstruction needs it to place edges exactly.
//
// Source: Bala, Walter and Greenberg, "Combining Edges and Points for Interactive High-Quality Rendering",
// SIGGRAPH 2003.
//
// Nearness is 1 / depth along the direction of view, per unit of length; 0 at infinity.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace pprt {

// A linear function f(x, y) of image points, pixels.
struct LinearForm {
  double constant = 0, per_x = 0, per_y = 0;

  double at(double x, double y) const { return constant + per_x * x + per_y * y; }
};

// A quadratic function f(x, y) of image points, pixels.
struct QuadraticForm {
  double constant = 0, per_x = 0, per_y = 0, per_xx = 0, per_xy = 0, per_yy = 0;

  double at(double x, double y) const {
    return constant + x * (per_x + per_xx * x + per_xy * y) + y * (per_y + per_yy * y);
  }
};

// A rectangle of image points, pixels.
struct ImageBounds {
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

inline constexpr ImageBounds kEverywhere = {
    -std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
    std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};

inline constexpr ImageBounds kNowhere = {1, 1, 0, 0};

// Returns the box about two boxes that are somewhere.
inline ImageBounds around(const ImageBounds& a, const ImageBounds& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

// A box about all of a primitive that may be seen, and how many quadrics or facets that is at most.
struct ShapeBounds {
  ImageBounds box = kNowhere;
  std::uint32_t parts = 0;
};

// A projected triangle. It covers the points at which no edge function is negative.
struct ImageFacet {
  std::array<LinearForm, 3> edges;
  LinearForm nearness;
  ImageBounds bounds;  // infinite where the triangle reaches behind the eye
};

// A projected sphere, cone or cylinder.
//
// A line of sight meets the surface where the discriminant is positive. With its square root r, the ray
// enters at nearness -middle + r and leaves at -middle - r; only positive values count. On a cone the height
// along the axis, height + along / nearness, must also lie within [0, top].
struct ImageQuadric {
  QuadraticForm discriminant;  // r squared
  LinearForm middle;
  bool has_ends = false;
  LinearForm along;
  double height = 0, top = 0;
  bool front = true, back = true;                          // which faces stop a ray
  float nearest = std::numeric_limits<float>::infinity();  // no point of it is nearer
  ImageBounds bounds =
      kEverywhere;  // so, too, where the surface reaches behind the eye; x0 > x1: it is not seen
};

// The projection of one primitive. kUnknown where it is not defined: the eye is next to its surface.
struct ImageShape {
  enum class Kind : std::uint8_t { kUnknown, kQuadric, kFacets };
  Kind kind = Kind::kUnknown;
  ImageQuadric quadric;
  std::vector<ImageFacet> facets;
};

}  // namespace pprt
