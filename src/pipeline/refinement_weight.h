// How much a Delaunay triangle wants to be refined (paper s. 3.6, after Eldar et al.).
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vector.h"

namespace pprt {

struct Circle {
  Vec2d center{0, 0};
  double radius_squared = 0;
};

struct TriangleShape {
  Circle circumcircle;
  double longest_edge_squared = 0;  // square pixels
};

// Twice the area below which a triangle counts as having it, in square pixels: keeps the circumcircle of
// collinear corners finite. Corners lie within 2^15 pixels and are rounded to 2^-38 of one, so twice the area
// of a proper triangle is above 1e-6 unless its corners touch within rounding.
inline constexpr double kSmallestDoubleArea = 1e-9;

inline TriangleShape triangle_shape(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const Vec2d ab = b - a, ac = c - a, bc = c - b;
  const double cross = std::max(ab.x * ac.y - ab.y * ac.x, kSmallestDoubleArea);
  const double ab2 = ab.dot(ab), ac2 = ac.dot(ac), bc2 = bc.dot(bc);
  const double half = 0.5 / cross;
  const Vec2d to_center((ac.y * ab2 - ab.y * ac2) * half, (ab.x * ac2 - ac.x * ab2) * half);
  return {{a + to_center, to_center.dot(to_center)}, std::max({ab2, ac2, bc2})};
}

// Held to [0, 1], by value: std::clamp goes by reference, hence by branches, which noise makes dear.
inline float held_to_unit(float v) {
  const float from_below = v > 0 ? v : 0;
  return from_below < 1 ? from_below : 1;
}

// Mean over the channels of the variance of three intensities on the display scale [0, 1]. The variance of
// three numbers is a ninth of the sum of their squared differences.
inline float display_variance(const Color& a, const Color& b, const Color& c) {
  const auto channel = [](float p, float q, float r) {
    p = held_to_unit(p), q = held_to_unit(q), r = held_to_unit(r);
    return (p - q) * (p - q) + (q - r) * (q - r) + (r - p) * (r - p);
  };
  return (channel(a.x, b.x, c.x) + channel(a.y, b.y, c.y) + channel(a.z, b.z, c.z)) * (1.0f / 27);
}

// The reasons to refine that count: all of them, but where a study asks what each is worth. Without area and
// variance there is no reason at all.
struct WeightTerms {
  bool area = true;        // Rad^2
  bool variance = true;    // log(1.01 + 500 Var)
  bool pixel_rule = true;  // a triangle smaller than a pixel has its variance as its only reason
};

// Weight(t) = Rad^2 log(1.01 + 500 Var), with two safeguards. Rad is at most the longest edge: a sliver on
// the hull has a circumradius of any size. A triangle whose circle is smaller than a pixel keeps only its
// variance as a reason (Painter and Sloan 1989): the constant 1.01 becomes 1, and a flat one has weight 0.
inline float refinement_weight(const TriangleShape& shape, float variance, const WeightTerms& terms = {}) {
  constexpr double kPixelRadiusSquared = 0.31830988618379067;  // 1 / pi: a circle of one square pixel
  if (!terms.area && !terms.variance) return 0;
  const double radius_squared = std::min(shape.circumcircle.radius_squared, shape.longest_edge_squared);
  const bool small = terms.pixel_rule && radius_squared < kPixelRadiusSquared;
  if (!terms.variance) return small ? 0.0f : static_cast<float>(radius_squared);
  const float detail = std::log((small ? 1.0f : 1.01f) + 500 * variance);
  return terms.area ? static_cast<float>(radius_squared) * detail : detail;
}

}  // namespace pprt
