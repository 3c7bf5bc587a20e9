// Triangles whose corners lie on different primitives: each of their points shows the primitive that is
// nearest there (docs/decisions/0017-edges.md). Private to the pipeline.
// Scalar twins: silhouette_patch_scalar.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/mesh/scan_conversion.h"
#include "pipeline/silhouettes/projected_shape_cache.h"
#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {

// Where points lie. On a line, in shares of the triangle's part of it. In a pixel, no two in one row or
// column.
inline constexpr PerPoint kPointsOnLine = {0.25F, 0.25F, 0.25F, 0.25F, 0.75F, 0.75F, 0.75F, 0.75F};
inline constexpr PerPoint kPixelColumns = {0.125F, 0.625F, 0.375F, 0.875F, 1.125F, 1.625F, 1.375F, 1.875F};
inline constexpr PerPoint kPixelRows = {0.375F, 0.125F, 0.875F, 0.625F, 0.375F, 0.125F, 0.875F, 0.625F};

// Whether one of a facet's edges separates it from all points within `margin` pixels, along the axes, of a
// triangle. The triangle's corners are in three of the lanes.
inline bool misses(const ProjectedFacet& facet, const float4& x, const float4& y, float margin) {
  return std::any_of(facet.edges.begin(), facet.edges.end(), [&](const NearLinear& edge) {
    const float reach = margin * (std::abs(edge.per_x) + std::abs(edge.per_y));
    return !any(edge.constant + edge.per_x * x + edge.per_y * y >= -reach);
  });
}

// One triangle with the shapes behind it. Made by SilhouetteFinder.
class SilhouettePatch {
 public:
  // A primitive of the corners.
  struct Candidate {
    float4 color;  // that it shows
    const ProjectedShapeCache::Shape* shape;
    float x, y;               // from the shape's origin to the patch's
    std::size_t first, last;  // of facets()
  };

  // What is shown where no primitive of the corners is: the background if a corner has hit it, else the mean
  // colour of the corners.
  const float4& beyond() const { return beyond_; }

  // Returns the integral of the colour's difference from `base` over parts of the lines of a row. They count
  // from `column`.
  float4 integral(int row, int column, const LineParts& parts, const float4& base) const;

  // Returns what two neighbouring pixels show, but for the interpolation's share. The centre of the first is
  // in the triangle, that of the second may be.
  std::array<float4, 2> at_pixels(int row, int column) const;

  // For the scalar twin.
  std::span<const Candidate> candidates() const { return {candidates_.data(), candidate_count_}; }
  std::span<const ProjectedFacet* const> facets() const { return facets_; }
  const Vec2d& origin() const { return origin_; }
  const float4& share_of_all() const { return share_of_all_; }

 private:
  friend class SilhouetteFinder;
  SilhouettePatch() = default;

  PerPoint nearness(const Candidate& candidate, const PerPoint& x, const PerPoint& y) const;
  std::array<PerPoint, 3> distribute(const PerPoint& weight, const PerPoint& x, const PerPoint& y) const;

  Vec2d origin_{0, 0};  // the first corner
  std::array<Candidate, 3> candidates_;
  std::size_t candidate_count_ = 0;
  float4 beyond_{}, share_of_all_{};
  std::span<const ProjectedFacet* const> facets_;  // those that may cover some of the triangle
};

// Makes the patches of triangles.
class SilhouetteFinder {
 public:
  explicit SilhouetteFinder(ProjectedShapeCache& shapes) : shapes_(shapes) {}

  // Returns the patch of a triangle whose corners show these primitives. Returns nothing where one of them
  // has no known shape, or all are the same. The patch may be evaluated within `margin` pixels, along the
  // axes, of the triangle. It is valid until the next call.
  std::optional<SilhouettePatch> find(const std::array<ScreenCorner, 3>& corners,
                                      const std::array<std::uint32_t, 3>& primitives, float margin);

 private:
  void add_candidate(SilhouettePatch& patch, const float4& color, const ProjectedShapeCache::Shape& shape,
                     const std::array<ScreenCorner, 3>& corners, float margin);
  void add_facets(const ProjectedShapeCache::Shape& shape, const std::array<ScreenCorner, 3>& corners,
                  float margin);

  ProjectedShapeCache& shapes_;
  std::vector<const ProjectedFacet*> facets_;  // of the last patch
};

inline std::optional<SilhouettePatch> SilhouetteFinder::find(const std::array<ScreenCorner, 3>& corners,
                                                             const std::array<std::uint32_t, 3>& primitives,
                                                             float margin) {
  const std::array<std::uint32_t, 3>& p = primitives;
  if (p[0] == p[1] && p[1] == p[2]) return std::nullopt;
  std::array<ProjectedShapeCache::Place, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (p[i] == 0) continue;
    places[i] = shapes_.find(p[i], {corners[i].x, corners[i].y});
    if (shapes_.shape(places[i]).kind == ImageShape::Kind::kUnknown) return std::nullopt;
  }
  SilhouettePatch patch;
  patch.origin_ = {corners[0].x, corners[0].y};
  facets_.clear();
  const float4 mean = (corners[0].color + corners[1].color + corners[2].color) * (1.0F / 3);
  patch.share_of_all_ = mean * (1 - kEdgeShare);
  patch.beyond_ = mean;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
    if (p[i] == p[last]) continue;  // both are handled at the other corner
    const float4& own = corners[i].color;
    const float4 on_primitive = p[i] == p[next] ? (own + corners[next].color) * 0.5F : own;
    const float4 color = on_primitive * kEdgeShare + patch.share_of_all_;
    if (p[i] == 0) {
      patch.beyond_ = color;
    } else {
      add_candidate(patch, color, shapes_.shape(places[i]), corners, margin);
    }
  }
  patch.facets_ = facets_;
  return patch;
}

inline void SilhouetteFinder::add_candidate(SilhouettePatch& patch, const float4& color,
                                            const ProjectedShapeCache::Shape& shape,
                                            const std::array<ScreenCorner, 3>& corners, float margin) {
  SilhouettePatch::Candidate& candidate = patch.candidates_[patch.candidate_count_++];
  candidate.color = color;
  candidate.shape = &shape;
  candidate.x = static_cast<float>(patch.origin_.x - shape.origin.x);
  candidate.y = static_cast<float>(patch.origin_.y - shape.origin.y);
  candidate.first = facets_.size();
  if (shape.kind == ImageShape::Kind::kFacets) add_facets(shape, corners, margin);
  candidate.last = facets_.size();
}

inline void SilhouetteFinder::add_facets(const ProjectedShapeCache::Shape& shape,
                                         const std::array<ScreenCorner, 3>& corners, float margin) {
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
  shapes_.for_each_facet(shape, bounds, [&](const ProjectedFacet& f) {
    if (!misses(f, x, y, margin)) facets_.push_back(&f);
  });
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

// Gives each point's weight to the candidate that is nearest there; to several that are equally near.
inline std::array<PerPoint, 3> SilhouettePatch::distribute(const PerPoint& weight, const PerPoint& x,
                                                           const PerPoint& y) const {
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

inline float4 SilhouettePatch::integral(int row, int column, const LineParts& parts,
                                        const float4& base) const {
  const auto twice = [](const PerLine& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3, 0, 1, 2, 3); };
  const PerPoint x = twice(parts.from) + twice(parts.to - parts.from) * kPointsOnLine +
                     static_cast<float>(column - origin_.x);
  const PerPoint y = twice(kLineOffsets) + static_cast<float>(row - origin_.y);
  const std::array<PerPoint, 3> found = distribute(twice(parts.length) * 0.5F, x, y);
  float4 integral = (beyond_ - base) * sum(parts.length);
  for (std::size_t i = 0; i < candidate_count_; ++i)
    integral += (candidates_[i].color - beyond_) * sum_of(found[i]);
  return integral;
}

inline std::array<float4, 2> SilhouettePatch::at_pixels(int row, int column) const {
  const PerPoint x = kPixelColumns + static_cast<float>(column - origin_.x);
  const PerPoint y = kPixelRows + static_cast<float>(row - origin_.y);
  const std::array<PerPoint, 3> found = distribute(PerPoint{} + 0.25F, x, y);
  std::array<float4, 2> colors = {beyond_ - share_of_all_, beyond_ - share_of_all_};
  for (std::size_t i = 0; i < candidate_count_; ++i) {
    const float4 difference = candidates_[i].color - beyond_;
    colors[0] += difference * sum(__builtin_shufflevector(found[i], found[i], 0, 1, 2, 3));
    colors[1] += difference * sum(__builtin_shufflevector(found[i], found[i], 4, 5, 6, 7));
  }
  return colors;
}

}  // namespace pprt
