// A triangle whose corners lie on different primitives: each part of it belongs to that of them which is
// nearest there. Private to the pipeline.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/sample_mesh.h"
#include "pipeline/scan_conversion.h"
#include "pipeline/viewed_primitives.h"

namespace pprt {

// Points dealt with at once: two on each line.
inline constexpr int kPoints = 2 * kLines;
using PerPoint = float __attribute__((vector_size(kPoints * sizeof(float))));

// Forms as in image_shape.h, over points given from an origin near them: there float has digits to spare.
struct NearLinear {
  float constant = 0, per_x = 0, per_y = 0;

  NearLinear() = default;
  NearLinear(const LinearForm& f, const Vec2d& origin)
      : constant(static_cast<float>(f.at(origin.x, origin.y))),
        per_x(static_cast<float>(f.per_x)),
        per_y(static_cast<float>(f.per_y)) {}

  PerPoint at(const PerPoint& x, const PerPoint& y) const { return constant + per_x * x + per_y * y; }
};

struct NearQuadratic {
  float constant = 0, per_x = 0, per_y = 0, per_xx = 0, per_xy = 0, per_yy = 0;

  NearQuadratic() = default;
  NearQuadratic(const QuadraticForm& f, const Vec2d& o)
      : constant(static_cast<float>(f.at(o.x, o.y))),
        per_x(static_cast<float>(f.per_x + 2 * f.per_xx * o.x + f.per_xy * o.y)),
        per_y(static_cast<float>(f.per_y + 2 * f.per_yy * o.y + f.per_xy * o.x)),
        per_xx(static_cast<float>(f.per_xx)),
        per_xy(static_cast<float>(f.per_xy)),
        per_yy(static_cast<float>(f.per_yy)) {}

  PerPoint at(const PerPoint& x, const PerPoint& y) const {
    return constant + x * (per_x + per_xx * x + per_xy * y) + y * (per_y + per_yy * y);
  }
};

inline float sum_of(const PerPoint& v) {
  return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]));
}

inline PerPoint square_root(const PerPoint& v) {
  PerPoint root;
  for (int i = 0; i < kPoints; ++i) root[i] = std::sqrt(v[i]);
  return root;
}

// How near a shape is; 0 where it is not.
class NearQuadric {
 public:
  NearQuadric() = default;
  NearQuadric(const ImageQuadric& q, const Vec2d& origin)
      : discriminant_(q.discriminant, origin),
        middle_(q.middle, origin),
        along_(q.along, origin),
        height_(static_cast<float>(q.height)),
        top_(static_cast<float>(q.top)),
        has_ends_(q.has_ends),
        front_(q.front),
        back_(q.back) {}

  PerPoint nearness(const PerPoint& x, const PerPoint& y) const {
    const PerPoint nothing{};
    const PerPoint discriminant = discriminant_.at(x, y), middle = middle_.at(x, y);
    const PerPoint root = square_root(discriminant > 0 ? discriminant : nothing);
    PerPoint front = discriminant >= 0 ? root - middle : nothing;
    if (front_ && !has_ends_) return front > 0 ? front : nothing;  // a sphere: its back is never nearer
    PerPoint back = discriminant >= 0 ? -root - middle : nothing;
    if (has_ends_) {
      const PerPoint along = along_.at(x, y);
      const auto held = [&](const PerPoint& n) {
        const PerPoint height = height_ * n + along;
        return (height >= 0) & (height <= top_ * n) ? n : nothing;
      };
      front = held(front), back = held(back);
    }
    if (!front_) front = nothing;
    if (!back_) back = nothing;
    const PerPoint nearest = front > 0 ? front : back;
    return nearest > 0 ? nearest : nothing;
  }

 private:
  NearQuadratic discriminant_;
  NearLinear middle_, along_;
  float height_ = 0, top_ = 0;
  bool has_ends_ = false, front_ = true, back_ = true;
};

class NearFacet {
 public:
  NearFacet(const ImageFacet& f, const Vec2d& origin)
      : edges_{NearLinear(f.edges[0], origin), NearLinear(f.edges[1], origin),
               NearLinear(f.edges[2], origin)},
        nearness_(f.nearness, origin) {}

  PerPoint nearness(const PerPoint& x, const PerPoint& y) const {
    const auto covered = (edges_[0].at(x, y) >= 0) & (edges_[1].at(x, y) >= 0) & (edges_[2].at(x, y) >= 0);
    return covered ? nearness_.at(x, y) : PerPoint{};
  }

 private:
  std::array<NearLinear, 3> edges_;
  NearLinear nearness_;
};

// Whether one of a facet's edges parts it from a triangle.
inline bool misses(const ImageFacet& facet, const std::array<Corner, 3>& corners) {
  const auto is_beyond = [&](const LinearForm& edge) {
    return edge.at(corners[0].x, corners[0].y) < 0 && edge.at(corners[1].x, corners[1].y) < 0 &&
           edge.at(corners[2].x, corners[2].y) < 0;
  };
  return is_beyond(facet.edges[0]) || is_beyond(facet.edges[1]) || is_beyond(facet.edges[2]);
}

class EdgePatch {
 public:
  // Of the corners' primitives; false where one has no known shape, or all are the same.
  bool set(const std::array<Corner, 3>& corners, const std::array<std::uint32_t, 3>& primitives,
           ViewedPrimitives& viewed);

  // What is shown where no primitive of the corners is: the background, if a corner has met it.
  const Color& beyond() const { return beyond_; }

  // The integral of the difference from `base` over parts of the lines of a row, which are so long and have
  // the ends `from` and `to`, counted from `column`; each of them at most a pixel.
  Color integral(int row, int column, const PerLine& from, const PerLine& to, const PerLine& length,
                 const Color& base) const;

 private:
  // A primitive of the corners.
  struct Side {
    Color color;
    bool is_quadric;
    NearQuadric quadric;
    std::size_t first, last;  // among the facets
  };

  void add_side(const Color& color, ViewedPrimitives::Place place, const std::array<Corner, 3>& corners,
                const ViewedPrimitives& viewed);
  PerPoint nearness(const Side& side, const PerPoint& x, const PerPoint& y) const;
  std::array<PerPoint, 3> shares(const PerPoint& x, const PerPoint& y, const PerPoint& weight) const;

  Vec2d origin_{0, 0};
  std::array<Side, 3> sides_;
  std::size_t side_count_ = 0;
  Color beyond_{0, 0, 0};
  std::vector<NearFacet> facets_;  // that may cover some of the triangle
};

inline bool EdgePatch::set(const std::array<Corner, 3>& corners, const std::array<std::uint32_t, 3>& p,
                           ViewedPrimitives& viewed) {
  if (p[0] == p[1] && p[1] == p[2]) return false;
  std::array<ViewedPrimitives::Place, 3> places{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (p[i] == 0) continue;
    places[i] = viewed.find(p[i]);
    if (viewed.kind(places[i]) == ImageShape::Kind::kUnknown) return false;
  }
  origin_ = {corners[0].x, corners[0].y};
  side_count_ = 0;
  facets_.clear();
  const Color between = (corners[0].color + corners[1].color + corners[2].color) * (1.0F / 3);
  const auto shown = [&](const Color& c) { return c * kEdgeShare + between * (1 - kEdgeShare); };
  beyond_ = between;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3, last = (i + 2) % 3;
    if (p[i] == p[last]) continue;  // taken together there
    const Color& own = corners[i].color;
    const Color color = shown(p[i] == p[next] ? (own + corners[next].color) * 0.5F : own);
    if (p[i] == 0) {
      beyond_ = color;
    } else {
      add_side(color, places[i], corners, viewed);
    }
  }
  return true;
}

inline void EdgePatch::add_side(const Color& color, ViewedPrimitives::Place place,
                                const std::array<Corner, 3>& corners, const ViewedPrimitives& viewed) {
  Side& side = sides_[side_count_++];
  side.color = color;
  side.is_quadric = viewed.kind(place) == ImageShape::Kind::kQuadric;
  if (side.is_quadric) {
    side.quadric = NearQuadric(viewed.quadric(place), origin_);
    return;
  }
  side.first = facets_.size();
  const auto [x0, x1] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [y0, y1] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  const ImageBounds bounds = {static_cast<float>(x0), static_cast<float>(y0), static_cast<float>(x1),
                              static_cast<float>(y1)};
  viewed.for_each_facet(place, bounds, [&](const ImageFacet& f) {
    if (!misses(f, corners)) facets_.emplace_back(f, origin_);
  });
  side.last = facets_.size();
}

inline PerPoint EdgePatch::nearness(const Side& side, const PerPoint& x, const PerPoint& y) const {
  if (side.is_quadric) return side.quadric.nearness(x, y);
  PerPoint nearest{};
  for (std::size_t i = side.first; i < side.last; ++i) {
    const PerPoint n = facets_[i].nearness(x, y);
    nearest = n > nearest ? n : nearest;
  }
  return nearest;
}

// Of what is seen at points, so much each: the sides' shares.
inline std::array<PerPoint, 3> EdgePatch::shares(const PerPoint& x, const PerPoint& y,
                                                 const PerPoint& weight) const {
  std::array<PerPoint, 3> near;
  PerPoint nearest{};
  for (std::size_t i = 0; i < side_count_; ++i) {
    near[i] = nearness(sides_[i], x, y);
    nearest = near[i] > nearest ? near[i] : nearest;
  }
  for (std::size_t i = 0; i < side_count_; ++i)
    near[i] = (near[i] == nearest) & (nearest > 0) ? weight : PerPoint{};
  return near;
}

inline Color EdgePatch::integral(int row, int column, const PerLine& from, const PerLine& to,
                                 const PerLine& length, const Color& base) const {
  const auto twice = [](const PerLine& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3, 0, 1, 2, 3); };
  constexpr PerPoint kQuarters = {0.25F, 0.25F, 0.25F, 0.25F, 0.75F, 0.75F, 0.75F, 0.75F};
  const PerPoint x = twice(from) + twice(to - from) * kQuarters + static_cast<float>(column - origin_.x);
  const PerPoint y = twice(kLineOffsets) + static_cast<float>(row - origin_.y);
  const std::array<PerPoint, 3> found = shares(x, y, twice(length) * 0.5F);
  Color integral = (beyond_ - base) * sum(length);
  for (std::size_t i = 0; i < side_count_; ++i) integral += (sides_[i].color - beyond_) * sum_of(found[i]);
  return integral;
}

}  // namespace pprt
