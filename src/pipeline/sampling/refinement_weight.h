// The weight of a Delaunay triangle: its priority in refinement (paper s. 3.6, after Eldar et al.).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "base/vector.h"
#include "pipeline/simd.h"

namespace pprt {

struct Circle {
  Vec2d center{0, 0};
  double radius_squared = 0;
};

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

// Clamps to [0, 1] without a branch. std::clamp takes references, hence branches, which noisy colours make
// slow.
inline float held_to_unit(float v) {
  const float from_below = v > 0 ? v : 0;
  return from_below < 1 ? from_below : 1;
}

// Clamps red, green and blue to [0, 1]; the last lane becomes 0. Scalar twin: held_to_unit().
inline float4 on_display(const float4& channels) {
  return min(max(channels, float4{}), float4{1, 1, 1, 0});
}

// Returns the mean over the channels of the variance of three intensities on the display scale [0, 1]. The
// variance of three numbers is a ninth of the sum of their squared differences.
inline float display_variance(const Color& a, const Color& b, const Color& c) {
  const auto channel = [](float p, float q, float r) {
    p = held_to_unit(p), q = held_to_unit(q), r = held_to_unit(r);
    return (p - q) * (p - q) + (q - r) * (q - r) + (r - p) * (r - p);
  };
  return (channel(a.x, b.x, c.x) + channel(a.y, b.y, c.y) + channel(a.z, b.z, c.z)) * (1.0f / 27);
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

// Returns the natural logarithm of one positive, normal float or of four, with a relative error below 4e-7;
// of 1 exactly 0. The polynomial is the minimax one (Remez) for log(1 + f) / f over [sqrt(1/2), sqrt(2)] - 1.
// Scalar twin: the instance for one float.
template <class Number>
Number fast_logarithm(const Number& x) {
  using Bits = std::conditional_t<std::is_same_v<Number, float>, std::int32_t, int4>;
  constexpr std::int32_t kRootOfHalf = 0x3f3504f3;
  const Bits bits = std::bit_cast<Bits>(x), exponent = (bits - kRootOfHalf) >> 23;
  const Number f = std::bit_cast<Number>(bits - (exponent << 23)) - 1;
  const Number high = 0.199001655F + f * (-0.172508298F + f * (0.162225803F + f * -0.10106895F));
  const Number all = 0.999999945F + f * (-0.500003651F + f * (0.333350589F + f * (-0.249699091F + f * high)));
  return f * all + as_numbers<Number>(exponent) * 0.693147181F;
}

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
