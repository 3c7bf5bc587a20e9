#include "pipeline/mesh/reconstruction.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/simd.h"
#include "pipeline/mesh/pixel_accumulator.h"
#include "pipeline/mesh/scan_conversion.h"
#include "pipeline/mesh/silhouette_patch.h"
#include "pipeline/mesh/triangle_rasteriser.h"

namespace pprt {
namespace {

std::array<ScreenCorner, 3> corners_of(const Delaunay::Triangle& triangle, const SampleMesh& mesh) {
  const auto corner = [&](std::size_t i) {
    const Delaunay::Index index = triangle.corners[i];
    const Vec2d& point = mesh.triangulation().points()[index];
    return ScreenCorner{point.x, point.y, mesh.corners()[index].channels()};
  };
  return {corner(0), corner(1), corner(2)};
}

std::array<std::uint32_t, 3> primitives_of(const Delaunay::Triangle& triangle, const SampleMesh& mesh) {
  const auto& [a, b, c] = triangle.corners;
  const auto& corners = mesh.corners();
  return {corners[a].primitive, corners[b].primitive, corners[c].primitive};
}

// Prefetches the corners of a triangle that comes up a little later. Slots hold triangles that lie anywhere.
void prefetch_corners(std::size_t slot, const SampleMesh& mesh) {
  constexpr std::size_t kAhead = 8;
  const auto& triangles = mesh.triangulation().triangles();
  if (slot + kAhead >= triangles.size()) return;
  for (const Delaunay::Index corner : triangles[slot + kAhead].corners) {
    if (corner == Delaunay::kInfinite) return;
    __builtin_prefetch(&mesh.triangulation().points()[corner]);
    __builtin_prefetch(&mesh.corners()[corner]);
  }
}

// Whether a triangle has corners on different primitives, of clearly different colours.
bool may_show_edge(const Delaunay::Triangle& triangle, const SampleMesh& mesh) {
  constexpr float kLeastVariance = 3e-4F;
  const auto& [a, b, c] = triangle.corners;
  const auto& corners = mesh.corners();
  if (corners[a].primitive == corners[b].primitive && corners[b].primitive == corners[c].primitive)
    return false;
  return display_variance(corners[a].color, corners[b].color, corners[c].color) > kLeastVariance;
}

// Whether a triangle is worth accumulating in every pixel that it touches. A sliver right across the image is
// not.
bool is_small(const Delaunay::Triangle& triangle, const SampleMesh& mesh) {
  constexpr double kLargest = 1.5;  // square pixels
  constexpr double kLongest = 16;   // pixels
  const auto& [a, b, c] = triangle.corners;
  const auto& points = mesh.triangulation().points();
  const Vec2d ab = points[b] - points[a], ac = points[c] - points[a];
  if (ab.x * ac.y - ab.y * ac.x > 2 * kLargest) return false;
  return std::max({ab.dot(ab), ac.dot(ac), (ab - ac).dot(ab - ac)}) <= kLongest * kLongest;
}

// Whether the triangles surely cover all pixels: they do if the image's corners are the first samples, with
// which all frames begin.
bool covers_image(const SampleMesh& mesh) {
  const TileGrid& grid = mesh.region().grid();
  const double width = grid.width, height = grid.height;
  const auto& points = mesh.triangulation().points();
  const std::array<Vec2d, 4> corners = {{{0, 0}, {width, 0}, {width, height}, {0, height}}};
  return points.size() > corners.size() && std::equal(corners.begin(), corners.end(), points.begin());
}

// Tells which triangles surely lie outside the bounds. None does if the bounds are the image.
class OutsideBounds {
 public:
  OutsideBounds(const SampleMesh& mesh, const PixelRect& bounds)
      : points_(mesh.triangulation().points().data()),
        bounds_(bounds),
        is_image_(bounds.width() == mesh.region().grid().width &&
                  bounds.height() == mesh.region().grid().height) {}

  bool operator()(const Delaunay::Triangle& triangle) const {
    if (is_image_) return false;
    const auto& [a, b, c] = triangle.corners;
    return std::max({points_[a].x, points_[b].x, points_[c].x}) < bounds_.x0 ||
           std::max({points_[a].y, points_[b].y, points_[c].y}) < bounds_.y0 ||
           std::min({points_[a].x, points_[b].x, points_[c].x}) > bounds_.x1 ||
           std::min({points_[a].y, points_[b].y, points_[c].y}) > bounds_.y1;
  }

 private:
  const Vec2d* points_;
  PixelRect bounds_;
  bool is_image_;
};

// First pass: the small triangles that show edges. They decide which pixels are accumulated, so they come
// before all others. Notes in `edges` what each triangle shows.
void accumulate_small_triangles(const SampleMesh& mesh, const OutsideBounds& is_outside,
                                SilhouetteFinder& silhouettes, TriangleRasteriser& rasteriser,
                                std::vector<TriangleEdge>& edges) {
  const auto& triangles = mesh.triangulation().triangles();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    prefetch_corners(i, mesh);
    const Delaunay::Triangle& t = triangles[i];
    if (!t.is_finite() || !may_show_edge(t, mesh) || is_outside(t)) continue;
    if (!is_small(t, mesh)) {
      edges[i] = TriangleEdge::kLarge;
      continue;
    }
    const std::array<ScreenCorner, 3> corners = corners_of(t, mesh);
    const std::optional<SilhouettePatch> patch = silhouettes.find(corners, primitives_of(t, mesh), 0);
    if (!patch) continue;
    edges[i] = TriangleEdge::kSmall;
    rasteriser.accumulate(corners, *patch);
  }
}

// Second pass: all other triangles. `silhouettes` is null where none shows edges.
void rasterise_triangles(const SampleMesh& mesh, const OutsideBounds& is_outside,
                         SilhouetteFinder* silhouettes, TriangleRasteriser& rasteriser,
                         const std::vector<TriangleEdge>& edges) {
  constexpr float kHalfAPixel = 0.5F;  // a pixel's points lie that far from its centre
  const auto& triangles = mesh.triangulation().triangles();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    prefetch_corners(i, mesh);
    const Delaunay::Triangle& t = triangles[i];
    if (!t.is_finite() || edges[i] == TriangleEdge::kSmall || is_outside(t)) continue;
    const std::array<ScreenCorner, 3> corners = corners_of(t, mesh);
    if (silhouettes != nullptr && edges[i] == TriangleEdge::kLarge) {
      if (const auto patch = silhouettes->find(corners, primitives_of(t, mesh), kHalfAPixel)) {
        rasteriser.rasterise(corners, *patch);
        continue;
      }
    }
    rasteriser.rasterise(corners, NoSilhouette());
  }
}

// Calls fill(row, left, right) for each row of one triangle: it holds the centres of the pixels in
// [left, right).
template <typename Fill>
void for_each_span(const std::array<ScreenCorner, 3>& corners, const PixelRect& bounds, const Fill& fill) {
  Outline outline(corners);
  const int top = std::max(first_center(outline.top()), bounds.y0);
  const int bottom = std::min(first_center(outline.bottom()), bounds.y1);
  if (top >= bottom) return;
  outline.prepare();
  for (int row = top; row < bottom; row += kLanes) {
    const Spans spans = spans_at(outline, row, bounds);
    for (int i = 0; i < kLanes; ++i) {
      if (spans.left[i] <= spans.last[i]) fill(row + i, spans.left[i], spans.last[i] + 1);
    }
  }
}

}  // namespace

PPRT_CLONED_FOR_WIDE_REGISTERS
void reconstruct(const SampleMesh& mesh, const PixelRect& bounds, PixelBlock& pixels,
                 ReconstructionBuffers& buffers, PixelRule rule, ProjectedShapeCache* viewed) {
  pixels.bounds = bounds;
  if (covers_image(mesh)) {
    pixels.colors.resize(bounds.area());
  } else {
    pixels.colors.assign(bounds.area(), Color(0, 0, 0));
  }
  buffers.edges.assign(mesh.triangulation().triangles().size(), TriangleEdge::kNone);
  const OutsideBounds is_outside(mesh, bounds);
  PixelAccumulator accumulator(bounds, buffers, rule);
  TriangleRasteriser rasteriser(pixels, accumulator, rule);
  accumulator.gather(mesh);
  if (rule == PixelRule::kEdges && viewed != nullptr) {
    SilhouetteFinder silhouettes(*viewed);
    accumulate_small_triangles(mesh, is_outside, silhouettes, rasteriser, buffers.edges);
    rasterise_triangles(mesh, is_outside, &silhouettes, rasteriser, buffers.edges);
  } else {
    rasterise_triangles(mesh, is_outside, nullptr, rasteriser, buffers.edges);
  }
  accumulator.write(pixels);
}

std::vector<std::uint32_t> triangle_at_centers(const SampleMesh& mesh, const PixelRect& bounds) {
  std::vector<std::uint32_t> result(bounds.area(), kNoTriangle);
  std::uint32_t number = 0;
  for (const Delaunay::Triangle& t : mesh.triangulation().triangles()) {
    if (!t.is_finite()) continue;
    for_each_span(corners_of(t, mesh), bounds, [&](int row, int left, int right) {
      std::uint32_t* pixel = result.data() + row_start(bounds, row);
      std::fill(pixel + left, pixel + right, number);
    });
    ++number;
  }
  return result;
}

}  // namespace pprt
