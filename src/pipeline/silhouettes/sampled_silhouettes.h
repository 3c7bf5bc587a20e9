// Which of the surfaces that samples lie on is seen between them, where it is not known what is visible: the
// nearest by their projected shapes. A surface that no sample lies on may hide it
// (docs/decisions/0033-visibility.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/silhouettes/projected_shape_cache.h"

namespace pprt {

class SampledSilhouettes {
 public:
  // `view` projects primitives 1 to `count`. Without one, or beyond the 24 bits that the lattice keeps of a
  // number, there are no silhouettes. `surfaces`: of each primitive the number of its surface, which is that
  // of a first one; those beyond are surfaces of their own. 0 is the background.
  SampledSilhouettes(ProjectedShapeCache::View view, std::uint32_t count,
                     std::span<const std::uint32_t> surfaces)
      : surfaces_(surfaces), has_shapes_(view != nullptr && count < 1U << 24), shapes_(std::move(view)) {}

  // Removes all shapes, because the eye has moved.
  void forget() { shapes_.forget(); }

  // Whether the picture is to show them.
  void show(bool shown) {
    are_shown_ = shown && has_shapes_;
    if (are_shown_ && joined_.size() < surfaces_.size()) find_joined();
  }
  bool are_shown() const { return are_shown_; }

  // Returns the surface that is nearest at an image point, pixels. Empty if none is there, or one of them has
  // no shape. Numbers may repeat. Only if they are shown.
  std::optional<std::uint32_t> nearest(const Vec2d& point, std::span<const std::uint32_t> surfaces);

  // Returns the shares of four surfaces in a square of the picture, counted at eight points. `corner`: image
  // point above and to the left; `side`: pixels. Where a number repeats, its first place has the share. What
  // no shape covers is the background's, if it is among them. Empty if one has no shape. Only if they are
  // shown.
  std::optional<std::array<float, 4>> shares(const Vec2d& corner, float side,
                                             std::span<const std::uint32_t, 4> surfaces);

 private:
  void find_joined();
  ProjectedShapeCache::Place place_of(std::uint32_t surface, const Vec2d& point);

  std::span<const std::uint32_t> surfaces_;
  std::vector<bool> joined_;  // surfaces of several primitives: they have no shape
  bool has_shapes_;
  ProjectedShapeCache shapes_;
  bool are_shown_ = false;
};

}  // namespace pprt
