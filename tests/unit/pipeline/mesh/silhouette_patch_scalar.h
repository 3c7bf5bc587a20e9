// Scalar twins of silhouette_patch.h and ProjectedShapeCache::for_each_facet(): one point or facet at a time,
// in the same order of operations, so both are equal to the bit. They stand here to be read beside the vector
// routines; only the tests that compare them call them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "base/image_shape.h"
#include "pipeline/mesh/silhouette_patch.h"
#include "unit/pipeline/mesh/scan_conversion_scalar.h"

namespace pprt::scalar {

inline float value(const NearLinear& f, float x, float y) {
  return f.constant + f.per_x * x + f.per_y * y;
}
inline float value(const NearQuadratic& f, float x, float y) {
  return f.constant + x * (f.per_x + f.per_xx * x + f.per_xy * y) + y * (f.per_y + f.per_yy * y);
}

// Scalar twin of nearness() of a quadric: the greatest nearness at which the line of sight crosses a side of
// it that is seen, or 0.
inline float nearness(const ProjectedQuadric& q, float x, float y) {
  const float discriminant = value(q.discriminant, x, y), middle = value(q.middle, x, y);
  if (!(discriminant >= 0)) return 0;
  const float root = std::sqrt(discriminant);
  const auto is_crossing = [&](float n) {
    if (!(n > 0)) return false;
    if (!q.has_ends) return true;
    const float height = q.height * n + value(q.along, x, y);
    return height >= 0 && height <= q.top * n;
  };
  const float front = root - middle, back = -root - middle;
  if (q.front && is_crossing(front)) return front;
  if (q.front && !q.has_ends) return 0;
  return q.back && is_crossing(back) ? back : 0;
}

// Scalar twin of nearness() of a facet.
inline float nearness(const ProjectedFacet& f, float x, float y) {
  const bool covered = std::all_of(f.edges.begin(), f.edges.end(),
                                   [&](const NearLinear& edge) { return value(edge, x, y) >= 0; });
  return covered ? value(f.nearness, x, y) : 0;
}

// Scalar twin of misses(). Corners as x, y.
inline bool misses(const ProjectedFacet& facet, const std::array<std::array<float, 2>, 3>& corners,
                   float margin) {
  return std::any_of(facet.edges.begin(), facet.edges.end(), [&](const NearLinear& edge) {
    const float reach = margin * (std::abs(edge.per_x) + std::abs(edge.per_y));
    return std::none_of(corners.begin(), corners.end(),
                        [&](const std::array<float, 2>& c) { return value(edge, c[0], c[1]) >= -reach; });
  });
}

// Scalar twin of ProjectedShapeCache::for_each_facet(): indices of the facets whose bounds meet a rectangle.
inline std::vector<std::size_t> facets_meeting(std::span<const ImageFacet> facets, const ImageBounds& r) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const ImageBounds& b = facets[i].bounds;
    if (b.x0 <= r.x1 && b.x1 >= r.x0 && b.y0 <= r.y1 && b.y1 >= r.y0) found.push_back(i);
  }
  return found;
}

// Scalar twin of SilhouettePatch::distribute(): whether each candidate is nearest at a point, which is given
// relative to the patch's origin.
inline std::array<bool, 3> nearest_candidates(const SilhouettePatch& patch, float x, float y) {
  std::array<float, 3> near{};
  for (std::size_t i = 0; i < patch.candidates().size(); ++i) {
    const SilhouettePatch::Candidate& c = patch.candidates()[i];
    const float from_x = x + c.x, from_y = y + c.y;
    if (c.shape->kind == ImageShape::Kind::kQuadric) {
      near[i] = nearness(c.shape->quadric, from_x, from_y);
    } else {
      for (std::size_t f = c.first; f < c.last; ++f)
        near[i] = std::max(near[i], nearness(*patch.facets()[f], from_x, from_y));
    }
  }
  const float nearest = std::max({near[0], near[1], near[2]});
  const auto is_nearest = [&](std::size_t i) {
    return i < patch.candidates().size() && nearest > 0 && near[i] == nearest;
  };
  return {is_nearest(0), is_nearest(1), is_nearest(2)};
}

// Scalar twin of SilhouettePatch::integral(): two points on each line.
inline Color integral(const SilhouettePatch& patch, int row, int column,
                      const std::array<LinePart, kLines>& parts, const Color& base) {
  std::array<std::array<float, kPoints>, 3> found{};  // per candidate and point
  std::array<float, kLines> length{};
  for (int point = 0; point < kPoints; ++point) {
    const int line = point % kLines;
    const LinePart& part = parts[static_cast<std::size_t>(line)];
    length[static_cast<std::size_t>(line)] = part.length;
    const float x = part.from + (part.to - part.from) * kPointsOnLine[point] +
                    static_cast<float>(column - patch.origin().x);
    const float y = kLineOffsets[line] + static_cast<float>(row - patch.origin().y);
    const std::array<bool, 3> is_nearest = nearest_candidates(patch, x, y);
    for (std::size_t i = 0; i < 3; ++i)
      found[i][static_cast<std::size_t>(point)] = is_nearest[i] ? part.length * 0.5F : 0;
  }
  const auto color = [](const float4& c) { return Color(c[0], c[1], c[2]); };
  Color integral = (color(patch.beyond()) - base) * sum(length);
  for (std::size_t i = 0; i < patch.candidates().size(); ++i) {
    const auto on_line = [&](std::size_t line) { return found[i][line] + found[i][line + kLines]; };
    integral += (color(patch.candidates()[i].color) - color(patch.beyond())) *
                sum({on_line(0), on_line(1), on_line(2), on_line(3)});
  }
  return integral;
}

// Scalar twin of SilhouettePatch::at_pixels(): four points in one pixel, the first or second of two.
inline Color at_pixel(const SilhouettePatch& patch, int row, int column, int second) {
  std::array<std::array<float, 4>, 3> found{};  // per candidate and point
  for (int i = 0; i < 4; ++i) {
    const int point = 4 * second + i;
    const float x = kPixelColumns[point] + static_cast<float>(column - patch.origin().x);
    const float y = kPixelRows[point] + static_cast<float>(row - patch.origin().y);
    const std::array<bool, 3> is_nearest = nearest_candidates(patch, x, y);
    for (std::size_t c = 0; c < 3; ++c) found[c][static_cast<std::size_t>(i)] = is_nearest[c] ? 0.25F : 0;
  }
  const auto color = [](const float4& c) { return Color(c[0], c[1], c[2]); };
  Color result = color(patch.beyond()) - color(patch.share_of_all());
  for (std::size_t c = 0; c < patch.candidates().size(); ++c)
    result += (color(patch.candidates()[c].color) - color(patch.beyond())) * sum(found[c]);
  return result;
}

}  // namespace pprt::scalar
