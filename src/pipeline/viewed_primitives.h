// What the primitives behind a picture's samples look like, asked once and kept while the eye rests.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "base/image_shape.h"

namespace pprt {

class ViewedPrimitives {
 public:
  // As Probe::view.
  using View = std::function<void(std::uint32_t primitive, ImageShape& shape)>;
  using Place = std::uint32_t;

  explicit ViewedPrimitives(View view) : view_(std::move(view)) {}

  // The eye has moved. Keeps the storage.
  void forget() {
    for (const std::uint32_t primitive : primitives_) places_[primitive] = kNotAsked;
    primitives_.clear();
    shapes_.clear();
    facets_.clear();
    bounds_.clear();
  }

  Place find(std::uint32_t primitive) {
    if (primitive >= places_.size()) places_.resize(std::size_t{primitive} + 1, kNotAsked);
    Place& place = places_[primitive];
    if (place == kNotAsked) place = ask(primitive);
    return place;
  }

  ImageShape::Kind kind(Place place) const { return shapes_[place].kind; }
  const ImageQuadric& quadric(Place place) const { return shapes_[place].quadric; }

  // Calls visit(facet) for those whose bounds meet a rectangle.
  template <class Visit>
  void for_each_facet(Place place, const ImageBounds& rectangle, const Visit& visit) const {
    const Shape& shape = shapes_[place];
    for (std::size_t i = shape.first_facet; i < shape.first_facet + shape.facets; ++i) {
      if (bounds_[i].meets(rectangle)) visit(facets_[i]);
    }
  }

 private:
  static constexpr Place kNotAsked = ~Place{0};

  struct Shape {
    ImageShape::Kind kind;
    ImageQuadric quadric;
    std::size_t first_facet, facets;
  };

  Place ask(std::uint32_t primitive) {
    view_(primitive, asked_);
    primitives_.push_back(primitive);
    shapes_.push_back({asked_.kind, asked_.quadric, facets_.size(), asked_.facets.size()});
    facets_.insert(facets_.end(), asked_.facets.begin(), asked_.facets.end());
    for (const ImageFacet& f : asked_.facets) bounds_.push_back(f.bounds);
    return static_cast<Place>(shapes_.size() - 1);
  }

  View view_;
  std::vector<Place> places_;              // by primitive
  std::vector<std::uint32_t> primitives_;  // those asked for
  std::vector<Shape> shapes_;
  std::vector<ImageFacet> facets_;
  std::vector<ImageBounds> bounds_;  // of the facets, close together: most are only asked for these
  ImageShape asked_;
};

}  // namespace pprt
