// A primitive as an eye sees it: which image points it covers, and how near it is there. What pictures need
// to have its edges where they are (after Bala, Walter and Greenberg, Combining Edges and Points for
// Interactive High-Quality Rendering, 2003).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pprt {

// f(x, y) over image points, in pixels.
struct LinearForm {
  double constant = 0, per_x = 0, per_y = 0;

  double at(double x, double y) const { return constant + per_x * x + per_y * y; }
};

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

// Nearness is one over the depth along the direction of view; 0 at infinity.

// A triangle: covers what none of its edges is negative at.
struct ImageFacet {
  std::array<LinearForm, 3> edges;
  LinearForm nearness;
  ImageBounds bounds;  // infinite where it reaches behind the eye
};

// A sphere, cone or cylinder: a line of sight where the discriminant is positive crosses its surface at the
// nearness -middle + root (into it) and -middle - root (out of it), those of them that are positive and, of a
// cone, whose height along its axis, height + along / nearness, lies within [0, top].
struct ImageQuadric {
  QuadraticForm discriminant;  // of its root's square
  LinearForm middle;
  bool has_ends = false;
  LinearForm along;
  double height = 0, top = 0;
  bool front = true, back = true;  // the sides that are seen
};

// One of these; kUnknown where an eye inside it, or next to its surface, sees no such thing.
struct ImageShape {
  enum class Kind : std::uint8_t { kUnknown, kQuadric, kFacets };
  Kind kind = Kind::kUnknown;
  ImageQuadric quadric;
  std::vector<ImageFacet> facets;
};

}  // namespace pprt
