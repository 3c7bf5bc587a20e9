// How near a projected shape is at an image point, or at several at once. Private to the pipeline.
// Scalar twins: silhouette_patch_scalar.h.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "pipeline/silhouettes/projected_shape_cache.h"

namespace pprt {

// Points evaluated at once.
inline constexpr int kPoints = 8;
using PerPoint = float __attribute__((vector_size(kPoints * sizeof(float))));

// A Number below is one point's (float) or that of all of them (PerPoint).

template <class Number>
Number value(const NearLinear& f, const Number& x, const Number& y) {
  return f.constant + f.per_x * x + f.per_y * y;
}
template <class Number>
Number value(const NearQuadratic& f, const Number& x, const Number& y) {
  return f.constant + x * (f.per_x + f.per_xx * x + f.per_xy * y) + y * (f.per_y + f.per_yy * y);
}

inline float sum_of(const PerPoint& v) {
  return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

inline float square_root(float v) {
  return std::sqrt(v);
}
inline PerPoint square_root(const PerPoint& v) {
  const float4 low = square_root(float4(__builtin_shufflevector(v, v, 0, 1, 2, 3)));
  const float4 high = square_root(float4(__builtin_shufflevector(v, v, 4, 5, 6, 7)));
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Returns the nearness of a shape (image_shape.h); 0 where the shape is not seen.
template <class Number>
Number nearness(const ProjectedQuadric& q, const Number& x, const Number& y) {
  const Number nothing{};
  const Number discriminant = value(q.discriminant, x, y), middle = value(q.middle, x, y);
  const Number root = square_root(discriminant > 0 ? discriminant : nothing);
  Number front = discriminant >= 0 ? root - middle : nothing;
  if (q.front && !q.has_ends) return front > 0 ? front : nothing;  // a sphere: its back is never nearer
  Number back = discriminant >= 0 ? -root - middle : nothing;
  if (q.has_ends) {
    const Number along = value(q.along, x, y);
    const auto held = [&](const Number& n) -> Number {
      const Number height = q.height * n + along;
      return (height >= 0) & (height <= q.top * n) ? n : nothing;
    };
    front = held(front), back = held(back);
  }
  if (!q.front) front = nothing;
  if (!q.back) back = nothing;
  const Number nearest = front > 0 ? front : back;
  return nearest > 0 ? nearest : nothing;
}

template <class Number>
Number nearness(const ProjectedFacet& f, const Number& x, const Number& y) {
  const auto covered =
      (value(f.edges[0], x, y) >= 0) & (value(f.edges[1], x, y) >= 0) & (value(f.edges[2], x, y) >= 0);
  return covered ? value(f.nearness, x, y) : Number{};
}

}  // namespace pprt
