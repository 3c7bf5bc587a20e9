// The shapes of the primitives behind a picture's samples, as seen from the eye: computed once each, and kept
// while the eye rests.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/image_shape.h"
#include "base/simd.h"
#include "base/vector.h"

namespace pprt {

// Forms as in image_shape.h, of points relative to an origin in or near the shape: there float has digits to
// spare (docs/numerics.md).
struct NearLinear {
  float constant = 0, per_x = 0, per_y = 0;

  NearLinear() = default;
  NearLinear(const LinearForm& f, const Vec2d& origin)
      : constant(static_cast<float>(f.at(origin.x, origin.y))),
        per_x(static_cast<float>(f.per_x)),
        per_y(static_cast<float>(f.per_y)) {}
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
};

struct ProjectedQuadric {
  NearQuadratic discriminant;
  NearLinear middle, along;
  float height = 0, top = 0;
  bool has_ends = false, front = true, back = true;

  ProjectedQuadric() = default;
  ProjectedQuadric(const ImageQuadric& q, const Vec2d& origin)
      : discriminant(q.discriminant, origin),
        middle(q.middle, origin),
        along(q.along, origin),
        height(static_cast<float>(q.height)),
        top(static_cast<float>(q.top)),
        has_ends(q.has_ends),
        front(q.front),
        back(q.back) {}
};

struct ProjectedFacet {
  std::array<NearLinear, 3> edges;
  NearLinear nearness;

  ProjectedFacet() = default;
  ProjectedFacet(const ImageFacet& f, const Vec2d& origin)
      : edges{NearLinear(f.edges[0], origin), NearLinear(f.edges[1], origin), NearLinear(f.edges[2], origin)},
        nearness(f.nearness, origin) {}
};

class ProjectedShapeCache {
 public:
  // Computes a primitive's shape, as Probe::view.
  using View = std::function<void(std::uint32_t primitive, ImageShape& shape)>;
  using Place = std::uint32_t;

  // A shape, relative to its origin. Its kind says whether the quadric or the facets count.
  struct Shape {
    ImageShape::Kind kind = ImageShape::Kind::kUnknown;
    Vec2d origin{0, 0};
    ProjectedQuadric quadric;
    std::size_t first_facet = 0, facets = 0;
  };

  explicit ProjectedShapeCache(View view) : view_(std::move(view)) {}

  // Removes all shapes, because the eye has moved; keeps the storage.
  void forget() {
    for (const std::uint32_t primitive : primitives_) place_of(primitive) = kNotAsked;
    primitives_.clear();
    shapes_.resize(1);
    facets_.clear();
    bounds_.clear();
  }

  // Returns where the shape of a primitive is kept, which a sample at this image point has hit. Primitives
  // from other ranks may have any number: unknown ones make no page.
  Place find(std::uint32_t primitive, const Vec2d& point) {
    const std::size_t page = primitive / kPage;
    const bool has_page = page < pages_.size() && pages_[page] != nullptr;
    if (has_page && place_of(primitive) != kNotAsked) return place_of(primitive);
    view_(primitive, asked_);
    const bool is_known = asked_.kind != ImageShape::Kind::kUnknown;
    if (!has_page) {
      if (!is_known) return kUnknown;
      make_page(page);
    }
    primitives_.push_back(primitive);
    return place_of(primitive) = is_known ? keep_asked(point) : kUnknown;
  }

  const Shape& shape(Place place) const { return shapes_[place]; }

  // Calls visit(facet) for the shape's facets whose bounds meet a rectangle.
  // Scalar twin: facets_meeting() in silhouette_patch_scalar.h.
  template <class Visit>
  void for_each_facet(const Shape& shape, const ImageBounds& rectangle, const Visit& visit) const {
    const ImageBounds& r = rectangle;
    const std::size_t end = shape.first_facet + shape.facets;
    for (std::size_t i = shape.first_facet; i < end; i += kLanes) {
      const FourBounds& b = bounds_[i / kLanes];
      const int4 meet = (load<float4>(b.x0) <= r.x1) & (load<float4>(b.x1) >= r.x0) &
                        (load<float4>(b.y0) <= r.y1) & (load<float4>(b.y1) >= r.y0);
      if (!any(meet)) continue;
      for (std::size_t lane = 0; lane < kLanes && i + lane < end; ++lane) {
        if (meet[lane] != 0) visit(facets_[i + lane]);
      }
    }
  }

 private:
  static constexpr Place kNotAsked = ~Place{0}, kUnknown = 0;

  // The places of primitives whose numbers follow each other. A region sees few primitives of a large scene.
  static constexpr std::size_t kPage = 1024;
  using Page = std::array<Place, kPage>;

  Place& place_of(std::uint32_t primitive) { return (*pages_[primitive / kPage])[primitive % kPage]; }
  void make_page(std::size_t page) {
    if (page >= pages_.size()) pages_.resize(page + 1);
    pages_[page] = std::make_unique<Page>();
    pages_[page]->fill(kNotAsked);
  }

  // The bounds of four facets, one a lane.
  struct FourBounds {
    float x0[kLanes], y0[kLanes], x1[kLanes], y1[kLanes];
  };

  // Each shape's facets begin a new FourBounds.
  Place keep_asked(const Vec2d& point) {
    facets_.resize(bounds_.size() * kLanes);
    shapes_.push_back({asked_.kind, point, {asked_.quadric, point}, facets_.size(), asked_.facets.size()});
    for (std::size_t i = 0; i < asked_.facets.size(); ++i) {
      const ImageFacet& f = asked_.facets[i];
      facets_.emplace_back(f, point);
      const std::size_t lane = i % kLanes;
      if (lane == 0) bounds_.emplace_back();
      FourBounds& four = bounds_.back();
      four.x0[lane] = f.bounds.x0, four.y0[lane] = f.bounds.y0;
      four.x1[lane] = f.bounds.x1, four.y1[lane] = f.bounds.y1;
    }
    return static_cast<Place>(shapes_.size() - 1);
  }

  View view_;
  std::vector<std::unique_ptr<Page>> pages_;           // null: none of its primitives was asked for
  std::vector<std::uint32_t> primitives_;              // those with a place
  std::vector<Shape> shapes_ = std::vector<Shape>(1);  // the first is kUnknown
  std::vector<ProjectedFacet> facets_;
  std::vector<FourBounds> bounds_;  // of the facets: for most of them only these are read
  ImageShape asked_;
};

}  // namespace pprt
