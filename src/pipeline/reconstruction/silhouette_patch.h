// A triangle whose corners lie on different primitives: each part of it belongs to that of them which is
// nearest there. Private to the pipeline.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/reconstruction/projected_shape_cache.h"
#include "pipeline/reconstruction/scan_conversion.h"
#include "pipeline/sampling/sample_mesh.h"

namespace pprt {

// Points dealt with at once: two on each line.
inline constexpr int kPoints = 2 * kLines;
using PerPoint = float __attribute__((vector_size(kPoints * sizeof(float))));

inline PerPoint value(const NearLinear& f, const PerPoint& x, const PerPoint& y) {
  return f.constant + f.per_x * x + f.per_y * y;
}
inline PerPoint value(const NearQuadratic& f, const PerPoint& x, const PerPoint& y) {
  return f.constant + x * (f.per_x + f.per_xx * x + f.per_xy * y) + y * (f.per_y + f.per_yy * y);
}

inline float sum_of(const PerPoint& v) {
  return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

inline PerPoint square_root(const PerPoint& v) {
  PerPoint root;
  for (int i = 0; i < kPoints; ++i) root[i] = std::sqrt(v[i]);
  return root;
}

// How near a shape is; 0 where it is not.
inline PerPoint nearness(const ProjectedQuadric& q, const PerPoint& x, const PerPoint& y) {
  const PerPoint nothing{};
  const PerPoint discriminant = value(q.discriminant, x, y), middle = value(q.middle, x, y);
  const PerPoint root = square_root(discriminant > 0 ? discriminant : nothing);
  PerPoint front = discriminant >= 0 ? root - middle : nothing;
  if (q.front && !q.has_ends) return front > 0 ? front : nothing;  // a sphere: its back is never nearer
  PerPoint back = discriminant >= 0 ? -root - middle : nothing;
  if (q.has_ends) {
    const PerPoint along = value(q.along, x, y);
    const auto held = [&](const PerPoint& n) {
      const PerPoint height = q.height * n + along;
      return (height >= 0) & (height <= q.top * n) ? n : nothing;
    };
    front = held(front), back = held(back);
  }
  if (!q.front) front = nothing;
  if (!q.back) back = nothing;
  const PerPoint nearest = front > 0 ? front : back;
  return nearest > 0 ? nearest : nothing;
}

inline PerPoint nearness(const ProjectedFacet& f, const PerPoint& x, const PerPoint& y) {
  const auto covered =
      (value(f.edges[0], x, y) >= 0) & (value(f.edges[1], x, y) >= 0) & (value(f.edges[2], x, y) >= 0);
  return covered ? value(f.nearness, x, y) : PerPoint{};
}

// Whether one of a facet's edges parts it from all that lies within `margin` pixels, along the axes, of a
// triangle, whose corners are in three of the lanes.
inline bool misses(const ProjectedFacet& facet, const float4& x, const float4& y, float margin) {
  return std::any_of(facet.edges.begin(), facet.edges.end(), [&](const NearLinear& edge) {
    const float reach = margin * (std::abs(edge.per_x) + std::abs(edge.per_y));
    return !any(edge.constant + edge.per_x * x + edge.per_y * y >= -reach);
  });
}

class SilhouettePatch {
 public:
  // Of the corners' primitives; false where one has no known shape, or all are the same. To be asked for
  // points within `margin` pixels, along the axes, of the triangle.
  bool set(const std::array<ScreenCorner, 3>& corners, const std::array<std::uint32_t, 3>& primitives,
           ProjectedShapeCache& viewed, float margin);

  // What is shown where no primitive of the corners is: the background, if a corner has met it.
  const float4& beyond() const { return beyond_; }

  // The integral of the difference from `base` over parts of the lines of a row, which are so long and have
  // the ends `from` and `to`, counted from `column`; each of them at most a pixel.
  float4 integral(int row, int column, const PerLine& from, const PerLine& to, const PerLine& length,
                  const float4& base) const;

  // Of two pixels candidate by candidate, the first of which has its centre in the triangle and the second
  // may: what they show but for the share of the interpolation.
  std::array<float4, 2> at_pixels(int row, int column) const;

 private:
  // A primitive of the corners.
  struct Candidate {
    float4 color;
    const ProjectedShapeCache::Shape* shape;
    float x, y;               // the triangle's origin from the shape's
    std::size_t first, last;  // among the facets
  };

  void add_candidate(const float4& color, const ProjectedShapeCache::Shape& shape,
                     const std::array<ScreenCorner, 3>& corners, const ProjectedShapeCache& viewed,
                     float margin);
  PerPoint nearness(const Candidate& candidate, const PerPoint& x, const PerPoint& y) const;
  std::array<PerPoint, 3> shares(const PerPoint& x, const PerPoint& y, const PerPoint& weight) const;

  Vec2d origin_{0, 0};
  std::array<Candidate, 3> candidates_;
  std::size_t candidate_count_ = 0;
  float4 beyond_{}, share_of_all_{};
  std::vector<const ProjectedFacet*> facets_;  // that may cover some of the triangle
};

inline bool SilhouettePatch::set(const std::array<ScreenCorner, 3>& corners,
                                 const std::array<std::uint32_t, 3>& p, ProjectedShapeCache& viewed,
                                 float margin) {
  if (p[0] == p[1] && p[1] == p[2]) return false;
  std::array<ProjectedShapeCache::Place, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (p[i] == 0) continue;
    places[i] = viewed.find(p[i], {corners[i].x, corners[i].y});
    if (viewed.shape(places[i]).kind == ImageShape::Kind::kUnknown) return false;
  }
  origin_ = {corners[0].x, corners[0].y};
  candidate_count_ = 0;
  facets_.clear();
  const float4 between = (corners[0].color + corners[1].color + corners[2].color) * (1.0F / 3);
  share_of_all_ = between * (1 - kEdgeShare);
  const auto shown = [&](const float4& c) { return c * kEdgeShare + share_of_all_; };
  beyond_ = between;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
    if (p[i] == p[last]) continue;  // taken together there
    const float4& own = corners[i].color;
    const float4 color = shown(p[i] == p[next] ? (own + corners[next].color) * 0.5F : own);
    if (p[i] == 0) {
      beyond_ = color;
    } else {
      add_candidate(color, viewed.shape(places[i]), corners, viewed, margin);
    }
  }
  return true;
}

inline void SilhouettePatch::add_candidate(const float4& color, const ProjectedShapeCache::Shape& shape,
                                           const std::array<ScreenCorner, 3>& corners,
                                           const ProjectedShapeCache& viewed, float margin) {
  Candidate& candidate = candidates_[candidate_count_++];
  candidate.color = color;
  candidate.shape = &shape;
  candidate.x = static_cast<float>(origin_.x - shape.origin.x),
  candidate.y = static_cast<float>(origin_.y - shape.origin.y);
  candidate.first = facets_.size();
  if (shape.kind == ImageShape::Kind::kFacets) {
    const auto [x0, x1] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
    const auto [y0, y1] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
    const ImageBounds bounds = {static_cast<float>(x0) - margin, static_cast<float>(y0) - margin,
                                static_cast<float>(x1) + margin, static_cast<float>(y1) + margin};
    const auto per_corner = [&](double ScreenCorner::*coordinate, double origin) {
      const auto from_origin = [&](int i) { return static_cast<float>(corners[i].*coordinate - origin); };
      return float4{from_origin(0), from_origin(1), from_origin(2), from_origin(2)};
    };
    const float4 x = per_corner(&ScreenCorner::x, shape.origin.x),
                 y = per_corner(&ScreenCorner::y, shape.origin.y);
    viewed.for_each_facet(shape, bounds, [&](const ProjectedFacet& f) {
      if (!misses(f, x, y, margin)) facets_.push_back(&f);
    });
  }
  candidate.last = facets_.size();
}

inline PerPoint SilhouettePatch::nearness(const Candidate& candidate, const PerPoint& x,
                                          const PerPoint& y) const {
  const PerPoint from_x = x + candidate.x, from_y = y + candidate.y;
  if (candidate.shape->kind == ImageShape::Kind::kQuadric)
    return pprt::nearness(candidate.shape->quadric, from_x, from_y);
  PerPoint nearest{};
  for (std::size_t i = candidate.first; i < candidate.last; ++i) {
    const PerPoint n = pprt::nearness(*facets_[i], from_x, from_y);
    nearest = n > nearest ? n : nearest;
  }
  return nearest;
}

// Of what is seen at points, so much each: the sides' shares.
inline std::array<PerPoint, 3> SilhouettePatch::shares(const PerPoint& x, const PerPoint& y,
                                                       const PerPoint& weight) const {
  std::array<PerPoint, 3> near;
  PerPoint nearest{};
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    near[i] = nearness(candidates_[i], x, y);
    nearest = near[i] > nearest ? near[i] : nearest;
  }
  for (std::size_t i = 0; i < candidate_count_; ++i)
    near[i] = (near[i] == nearest) & (nearest > 0) ? weight : PerPoint{};
  return near;
}

inline float4 SilhouettePatch::integral(int row, int column, const PerLine& from, const PerLine& to,
                                        const PerLine& length, const float4& base) const {
  const auto twice = [](const PerLine& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3, 0, 1, 2, 3); };
  constexpr PerPoint kQuarters = {0.25F, 0.25F, 0.25F, 0.25F, 0.75F, 0.75F, 0.75F, 0.75F};
  const PerPoint x = twice(from) + twice(to - from) * kQuarters + static_cast<float>(column - origin_.x);
  const PerPoint y = twice(kLineOffsets) + static_cast<float>(row - origin_.y);
  const std::array<PerPoint, 3> found = shares(x, y, twice(length) * 0.5F);
  float4 integral = (beyond_ - base) * sum(length);
  for (std::size_t i = 0; i < candidate_count_; ++i)
    integral += (candidates_[i].color - beyond_) * sum_of(found[i]);
  return integral;
}

// Four points a pixel, no two on one line or column.
inline std::array<float4, 2> SilhouettePatch::at_pixels(int row, int column) const {
  constexpr PerPoint kColumns = {0.125F, 0.625F, 0.375F, 0.875F, 1.125F, 1.625F, 1.375F, 1.875F};
  constexpr PerPoint kRows = {0.375F, 0.125F, 0.875F, 0.625F, 0.375F, 0.125F, 0.875F, 0.625F};
  const PerPoint x = kColumns + static_cast<float>(column - origin_.x);
  const PerPoint y = kRows + static_cast<float>(row - origin_.y);
  const std::array<PerPoint, 3> found = shares(x, y, PerPoint{} + 0.25F);
  std::array<float4, 2> colors = {beyond_ - share_of_all_, beyond_ - share_of_all_};
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    const float4 difference = candidates_[i].color - beyond_;
    colors[0] += difference * sum(__builtin_shufflevector(found[i], found[i], 0, 1, 2, 3));
    colors[1] += difference * sum(__builtin_shufflevector(found[i], found[i], 4, 5, 6, 7));
  }
  return colors;
}

}  // namespace pprt
