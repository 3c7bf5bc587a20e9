// The weight of a Delaunay triangle: its priority in refinement (paper s. 3.6, after Eldar et al.).
#pragma once

#include <algorithm>

#include "base/vector.h"
#include "pipeline/core/circle.h"
#include "pipeline/core/display_values.h"
#include "pipeline/core/octaves.h"

namespace pprt {

struct TriangleShape {
  Circle circumcircle;
  double longest_edge_squared = 0;  // square pixels
};

// Lower bound of twice a triangle's area, square pixels. It keeps the circumcircle of collinear corners
// finite. Corners lie within 2^15 pixels and are rounded to 2^-38 of one, so twice the area of a proper
// triangle is above 1e-6 unless its corners touch within rounding.
inline constexpr double kSmallestDoubleArea = 1e-9;

// Corners counter-clockwise, pixels.
inline TriangleShape triangle_shape(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const Vec2d ab = b - a, ac = c - a, bc = c - b;
  const double cross = std::max(ab.x * ac.y - ab.y * ac.x, kSmallestDoubleArea);
  const double ab2 = ab.dot(ab), ac2 = ac.dot(ac), bc2 = bc.dot(bc);
  const double half = 0.5 / cross;
  const Vec2d to_center((ac.y * ab2 - ab.y * ac2) * half, (ab.x * ac2 - ac.x * ab2) * half);
  return {{a + to_center, to_center.dot(to_center)}, std::max({ab2, ac2, bc2})};
}

// The terms of the weight that are in force. All of them, unless a study measures what each is worth. Without
// area and variance every weight is 0.
struct WeightTerms {
  bool area = true;        // Rad^2
  bool variance = true;    // log(1.01 + 500 Var)
  bool pixel_rule = true;  // below the size of a pixel only the variance counts
  bool learned = true;     // multiplied by LearnedWeights; below a pixel also by its size
  bool edges = true;       // errors are learned from pictures that show edges (PixelRule::kEdges)
};

inline constexpr float kPixelSizeSquared = 0.318309886F;  // 1 / pi: a circle of one square pixel

// Returns Weight(t) = Rad^2 log(1.01 + 500 Var) of one triangle or of four, from Rad^2 in square pixels and
// Var. Two safeguards. Rad is at most the longest edge: a sliver on the hull has a circumradius of any size.
// Where the circle is smaller than a pixel, only the variance counts (Painter and Sloan 1989). The constant
// 1.01 becomes 1, and a triangle of one colour has weight 0.
// Scalar twin: the instance for one triangle.
template <class Number>
Number refinement_weight(const Number& size_squared, const Number& variance, const WeightTerms& terms = {}) {
  const Number nothing{};
  if (!terms.area && !terms.variance) return nothing;
  const auto small = size_squared < (terms.pixel_rule ? kPixelSizeSquared : 0);
  if (!terms.variance) return small ? nothing : size_squared;
  const Number detail = fast_logarithm((small ? nothing + 1 : nothing + 1.01F) + 500 * variance);
  return terms.area ? size_squared * detail : detail;
}

inline float refinement_weight(const TriangleShape& shape, float variance, const WeightTerms& terms = {}) {
  const double size_squared = std::min(shape.circumcircle.radius_squared, shape.longest_edge_squared);
  return refinement_weight(static_cast<float>(size_squared), variance, terms);
}

}  // namespace pprt
