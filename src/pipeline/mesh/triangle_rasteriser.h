// Draws triangles into pixels: the interpolation at pixel centres, and integrals over the area of accumulated
// pixels. Private to the pipeline.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "pipeline/mesh/pixel_accumulator.h"
#include "pipeline/mesh/scan_conversion.h"
#include "pipeline/mesh/silhouette_patch.h"

namespace pprt {

// In place of a SilhouettePatch, for triangles that show no edges.
struct NoSilhouette {};

class TriangleRasteriser {
 public:
  TriangleRasteriser(PixelBlock& pixels, PixelAccumulator& accumulator, PixelRule rule)
      : pixels_(pixels),
        bounds_(pixels.bounds),
        accumulator_(accumulator),
        takes_area_(rule == PixelRule::kArea || rule == PixelRule::kEdges) {}

  // Fills the pixels whose centres the triangle holds. Adds its part of the area of accumulated pixels,
  // unless the rule takes no areas. `silhouette` is a SilhouettePatch or NoSilhouette.
  template <class Silhouette>
  void rasterise(const std::array<ScreenCorner, 3>& corners, const Silhouette& silhouette);

  // Accumulates every pixel that the triangle touches or whose centre it holds, and adds its part of their
  // area.
  void accumulate(const std::array<ScreenCorner, 3>& corners, const SilhouettePatch& silhouette);

 private:
  // The interpolation over consecutive pixels of a row.
  struct Run {
    int row, left, steps;
    float4 first, step;

    float4 at(int x) const { return first + step * static_cast<float>(x); }
  };

  template <class Silhouette>
  void fill(const LinearPatch& patch, const Silhouette& silhouette, int first_row, const Spans& spans);
  void fill_run(const Run& run, const NoSilhouette& none);
  void fill_run(const Run& run, const SilhouettePatch& silhouette);
  template <class Silhouette>
  void add_areas(const Outline& outline, const LinearPatch& patch, const Silhouette& silhouette, int row);
  void accumulate_touched(const ExtentPerLine& extents, const SilhouettePatch& silhouette, int row, int left,
                          int right);
  void accumulate_centers(int row, const Extent& extent, const SilhouettePatch& silhouette);

  PixelBlock& pixels_;
  const PixelRect bounds_;
  PixelAccumulator& accumulator_;
  const bool takes_area_;
};

template <class Silhouette>
void TriangleRasteriser::rasterise(const std::array<ScreenCorner, 3>& corners, const Silhouette& silhouette) {
  Outline outline(corners);
  // Rows that the triangle touches or, where only centres count, whose centres it may hold.
  const int top =
      std::max(takes_area_ ? floor_to_int(outline.top()) : first_center(outline.top()), bounds_.y0);
  const int bottom =
      std::min(takes_area_ ? ceil_to_int(outline.bottom()) : first_center(outline.bottom()), bounds_.y1);
  if (top >= bottom) return;
  outline.prepare();
  const LinearPatch patch(corners);
  for (int row = top; row < bottom; row += kLanes)
    fill(patch, silhouette, row, spans_at(outline, row, bounds_));
  if (!takes_area_) return;
  for (int row = top; row < bottom; ++row) add_areas(outline, patch, silhouette, row);
}

// Fills the spans of four rows. Evaluates both ends of each span and interpolates between them: that is as
// exact, and needs no clamping in between. Scalar twin: fill_span() in scan_conversion_scalar.h.
template <class Silhouette>
void TriangleRasteriser::fill(const LinearPatch& patch, const Silhouette& silhouette, int first_row,
                              const Spans& spans) {
  if (!any(spans.left <= spans.last)) return;
  auto [r, g, b] = patch.at_centers(spans.left, first_row);
  const auto [r_last, g_last, b_last] = patch.at_centers(spans.last, first_row);
  const int4 steps = spans.last - spans.left;
  const float4 share = 1 / __builtin_convertvector(steps > 0 ? steps : int4{} + 1, float4);
  float4 r_step = (r_last - r) * share, g_step = (g_last - g) * share, b_step = (b_last - b) * share;
  std::array<float4, kLanes> first, step;
  float4 none{}, none_either{};
  transpose(r, g, b, none);
  transpose(r_step, g_step, b_step, none_either);
  first = {r, g, b, none}, step = {r_step, g_step, b_step, none_either};
  for (int i = 0; i < kLanes; ++i) {
    if (steps[i] < 0) continue;
    fill_run({first_row + i, spans.left[i], steps[i], first[i], step[i]}, silhouette);
  }
}

inline void TriangleRasteriser::fill_run(const Run& run, const NoSilhouette&) {
  Color* pixel = pixels_.colors.data() + row_start(bounds_, run.row) + run.left;
  for (int x = 0; x <= run.steps; ++x) store_channels(run.at(x), pixel[x]);
}

// Two pixels at a time. The second of the last pair may lie beyond the span.
inline void TriangleRasteriser::fill_run(const Run& run, const SilhouettePatch& silhouette) {
  Color* pixel = pixels_.colors.data() + row_start(bounds_, run.row) + run.left;
  for (int x = 0; x <= run.steps; x += 2) {
    const auto [left, right] = silhouette.at_pixels(run.row, run.left + x);
    store_channels(left + run.at(x) * (1 - kEdgeShare), pixel[x]);
    if (x < run.steps) store_channels(right + run.at(x + 1) * (1 - kEdgeShare), pixel[x + 1]);
  }
}

// Adds the triangle's part of the area of each accumulated pixel in a row.
template <class Silhouette>
void TriangleRasteriser::add_areas(const Outline& outline, const LinearPatch& patch,
                                   const Silhouette& silhouette, int row) {
  const int left = std::max(floor_to_int(outline.left()), bounds_.x0) - bounds_.x0;
  const int right = std::min(floor_to_int(outline.right()), bounds_.x1 - 1) - bounds_.x0;
  if (left > right || !accumulator_.any_between(row, left, right)) return;
  const ExtentPerLine extents = outline.along(row, bounds_.x0 + left);
  const LinearPatch::OnLines plane(patch, row, bounds_.x0 + left);
  accumulator_.for_each_between(row, left, right, [&](int column) {
    const LineParts parts = parts_in_pixel(extents, column - left);
    if (sum(parts.length) == 0) return;
    const auto pixel = static_cast<std::size_t>(row_start(bounds_, row) + bounds_.x0 + column);
    const float4 base = accumulator_.base_of(pixel);
    if constexpr (std::is_same_v<Silhouette, NoSilhouette>) {
      accumulator_.add_difference(pixel, plane.integral(0.5f * (parts.from + parts.to), parts.length, base));
    } else {
      accumulator_.add_difference(pixel, silhouette.integral(row, bounds_.x0 + left, parts, base));
    }
  });
}

inline void TriangleRasteriser::accumulate(const std::array<ScreenCorner, 3>& corners,
                                           const SilhouettePatch& silhouette) {
  Outline outline(corners);
  const int top = std::max(floor_to_int(outline.top()), bounds_.y0);
  const int bottom = std::min(ceil_to_int(outline.bottom()), bounds_.y1);
  const int left = std::max(floor_to_int(outline.left()), bounds_.x0);
  const int right = std::min(ceil_to_int(outline.right()), bounds_.x1);
  if (top >= bottom || left >= right) return;
  outline.prepare();
  for (int row = top; row < bottom; ++row) {
    accumulate_touched(outline.along(row, left), silhouette, row, left, right);
    const double center = row + 0.5;
    if (outline.top() <= center && center < outline.bottom())
      accumulate_centers(row, outline.at(center), silhouette);
  }
}

inline void TriangleRasteriser::accumulate_touched(const ExtentPerLine& extents,
                                                   const SilhouettePatch& silhouette, int row, int left,
                                                   int right) {
  for (int x = left; x < right; ++x) {
    const LineParts parts = parts_in_pixel(extents, x - left);
    if (sum(parts.length) == 0) continue;
    accumulator_.accumulate_at(x, row, silhouette.beyond());
    const std::size_t pixel = accumulator_.number_of(x, row);
    accumulator_.add_difference(pixel, silhouette.integral(row, left, parts, accumulator_.base_of(pixel)));
  }
}

// A thin triangle may hold centres between its lines.
inline void TriangleRasteriser::accumulate_centers(int row, const Extent& extent,
                                                   const SilhouettePatch& silhouette) {
  const int left = std::max(first_center(extent.left), bounds_.x0);
  const int right = std::min(first_center(extent.right), bounds_.x1);
  for (int x = left; x < right; ++x) accumulator_.accumulate_at(x, row, silhouette.beyond());
}

}  // namespace pprt
