#include "pipeline/reconstruction/reconstruction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <type_traits>
#include <utility>

#include "pipeline/reconstruction/scan_conversion.h"
#include "pipeline/reconstruction/silhouette_patch.h"
#include "pipeline/sampling/sample_mesh.h"
#include "pipeline/simd.h"

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

// Slots hold triangles that lie anywhere. Prefetches the corners of one that comes up a little later.
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

// Whether a triangle has corners on different primitives, of colours that tell.
bool may_show_edge(const Delaunay::Triangle& triangle, const SampleMesh& mesh) {
  constexpr float kLeastVariance = 3e-4F;
  const auto& [a, b, c] = triangle.corners;
  const auto& corners = mesh.corners();
  if (corners[a].primitive == corners[b].primitive && corners[b].primitive == corners[c].primitive)
    return false;
  return display_variance(corners[a].color, corners[b].color, corners[c].color) > kLeastVariance;
}

// Whether it is worth looking at every part of a pixel that the triangle touches. Not at those of a sliver
// right across the image.
bool is_small(const Delaunay::Triangle& triangle, const SampleMesh& mesh) {
  constexpr double kLargest = 1.5;  // square pixels
  constexpr double kLongest = 16;   // pixels
  const auto& [a, b, c] = triangle.corners;
  const auto& points = mesh.triangulation().points();
  const Vec2d ab = points[b] - points[a], ac = points[c] - points[a];
  if (ab.x * ac.y - ab.y * ac.x > 2 * kLargest) return false;
  return std::max({ab.dot(ab), ac.dot(ac), (ab - ac).dot(ab - ac)}) <= kLongest * kLongest;
}

// Whether every pixel lies in some triangle: as with the image's corners for the first samples, which all
// frames begin with.
bool covers_image(const SampleMesh& mesh) {
  const TileGrid& grid = mesh.region().grid();
  const double width = grid.width, height = grid.height;
  const auto& points = mesh.triangulation().points();
  const std::array<Vec2d, 4> corners = {{{0, 0}, {width, 0}, {width, height}, {0, height}}};
  return points.size() > corners.size() && std::equal(corners.begin(), corners.end(), points.begin());
}

// Which triangles surely lie beside the bounds: none if these are the image.
class Beside {
 public:
  Beside(const SampleMesh& mesh, const PixelRect& bounds)
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

// Where a row of the bounds begins, as if its first pixel were number 0.
std::ptrdiff_t row_start(const PixelRect& bounds, int row) {
  return static_cast<std::ptrdiff_t>(row - bounds.y0) * bounds.width() - bounds.x0;
}

// In four rows, the pixels whose centres a triangle holds.
struct Spans {
  int4 left, last;  // none where last < left
};

Spans spans_at(const Outline& outline, int first_row, const PixelRect& bounds) {
  const ExactExtents extents = outline.at(kCenterOffsets + first_row);
  const int4 row = int4{0, 1, 2, 3} + first_row;
  const int4 last = min(first_centers(extents.right), int4{} + bounds.x1) - 1;
  const auto is_inside = (row >= bounds.y0) & (row < bounds.y1);
  return {max(first_centers(extents.left), int4{} + bounds.x0), is_inside ? last : int4{} - 1};
}

// Calls fill(row, left, right) for the pixel centres of one triangle: in each row those in [left, right).
template <typename Fill>
void for_each_span(const std::array<ScreenCorner, 3>& corner, const PixelRect& bounds, const Fill& fill) {
  Outline outline(corner);
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

// The interpolation from one pixel of a row to another.
struct Run {
  int row, left, steps;
  float4 first, step;

  float4 at(int x) const { return first + step * static_cast<float>(x); }
};

// In place of an SilhouettePatch.
struct NoEdge {};

// One triangle after another.
class Painter {
 public:
  Painter(RegionPixels& pixels, ReconstructionBuffers& buffers, PixelRule rule)
      : pixels_(pixels), bounds_(pixels.bounds), buffers_(buffers), rule_(rule) {}

  void gather(const SampleMesh& mesh);
  template <class Edge>
  void paint(const std::array<ScreenCorner, 3>& corner, const Edge& edge);
  void paint_by_area(const std::array<ScreenCorner, 3>& corner, const SilhouettePatch& edge);
  void finish();

 private:
  std::size_t words_per_row() const { return (static_cast<std::size_t>(bounds_.width()) + 63) / 64; }

  // Where the buffers have a pixel.
  struct PixelPlace {
    std::size_t pixel, word;
    std::uint64_t bit;
  };
  PixelPlace place_of(int x, int y) const {
    const auto column = static_cast<std::size_t>(x - bounds_.x0);
    return {static_cast<std::size_t>(row_start(bounds_, y) + x),
            static_cast<std::size_t>(y - bounds_.y0) * words_per_row() + column / 64,
            std::uint64_t{1} << (column % 64)};
  }

  void add_edge_lines(const ExtentPerLine& extents, const SilhouettePatch& edge, int row, int left,
                      int right);
  void add_sample(int x, int y, const float4& color);
  template <class Edge>
  void fill(const LinearPatch& patch, const Edge& edge, int first_row, const Spans& spans);
  void fill_run(const Run& run, const NoEdge& none);
  void fill_run(const Run& run, const SilhouettePatch& edge);
  template <class Edge>
  void add_lines(const Outline& outline, const LinearPatch& patch, const Edge& edge, int row);
  void show_by_area(int row, const Extent& extent, const SilhouettePatch& edge);
  void show_by_area(const PixelPlace& place, const float4& color);
  void start_sum(const PixelPlace& place);
  float4 base_of(std::size_t pixel) const { return load<float4>(buffers_.sums[pixel].base); }
  float4 differences_of(std::size_t pixel) const { return load<float4>(buffers_.sums[pixel].differences); }
  void add_difference(std::size_t pixel, const float4& color) {
    store(differences_of(pixel) + color, buffers_.sums[pixel].differences);
  }
  bool takes_area() const { return rule_ == PixelRule::kArea || rule_ == PixelRule::kEdges; }
  bool several_between(int row, int left, int right) const;

  RegionPixels& pixels_;
  const PixelRect bounds_;
  ReconstructionBuffers& buffers_;
  PixelRule rule_;
};

// Which pixels hold several samples, and of what colours.
void Painter::gather(const SampleMesh& mesh) {
  ReconstructionBuffers& b = buffers_;
  b.pixels.clear();
  if (rule_ == PixelRule::kCenter) return;
  for (auto* bits : {&b.holds_one, &b.holds_several})
    bits->assign(words_per_row() * static_cast<std::size_t>(bounds_.height()), 0);
  b.sums.resize(bounds_.area());
  const TileGrid& grid = mesh.region().grid();
  const auto& points = mesh.triangulation().points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int x = std::min(static_cast<int>(points[i].x), grid.width - 1);
    const int y = std::min(static_cast<int>(points[i].y), grid.height - 1);
    if (x < bounds_.x0 || x >= bounds_.x1 || y < bounds_.y0 || y >= bounds_.y1) continue;
    add_sample(x, y, mesh.corners()[i].channels());
  }
}

void Painter::add_sample(int x, int y, const float4& color) {
  ReconstructionBuffers& b = buffers_;
  const PixelPlace place = place_of(x, y);
  if ((b.holds_one[place.word] & place.bit) == 0) {
    b.holds_one[place.word] |= place.bit;
    store(color, b.sums[place.pixel].base);
    return;
  }
  if ((b.holds_several[place.word] & place.bit) == 0) start_sum(place);
  if (rule_ == PixelRule::kMean)
    add_difference(place.pixel, color - base_of(place.pixel) + float4{0, 0, 0, 1});
}

template <class Edge>
void Painter::paint(const std::array<ScreenCorner, 3>& corner, const Edge& edge) {
  Outline outline(corner);
  const bool area = takes_area();
  // Rows that the triangle touches or, where only centres count, whose centres it may hold.
  const int top = std::max(area ? floor_to_int(outline.top()) : first_center(outline.top()), bounds_.y0);
  const int bottom =
      std::min(area ? ceil_to_int(outline.bottom()) : first_center(outline.bottom()), bounds_.y1);
  if (top >= bottom) return;
  outline.prepare();
  const LinearPatch patch(corner);
  for (int row = top; row < bottom; row += kLanes) fill(patch, edge, row, spans_at(outline, row, bounds_));
  if (!area) return;
  for (int row = top; row < bottom; ++row) add_lines(outline, patch, edge, row);
}

// Evaluates the ends of spans and goes from one to the other: as exact, and needs no care in between.
template <class Edge>
void Painter::fill(const LinearPatch& patch, const Edge& edge, int first_row, const Spans& spans) {
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
    fill_run({first_row + i, spans.left[i], steps[i], first[i], step[i]}, edge);
  }
}

void Painter::fill_run(const Run& run, const NoEdge&) {
  Color* pixel = pixels_.colors.data() + row_start(bounds_, run.row) + run.left;
  for (int x = 0; x <= run.steps; ++x) store_channels(run.at(x), pixel[x]);
}

void Painter::fill_run(const Run& run, const SilhouettePatch& edge) {
  Color* pixel = pixels_.colors.data() + row_start(bounds_, run.row) + run.left;
  for (int x = 0; x <= run.steps; x += 2) {
    const auto [left, right] = edge.at_pixels(run.row, run.left + x);
    store_channels(left + run.at(x) * (1 - kEdgeShare), pixel[x]);
    if (x < run.steps) store_channels(right + run.at(x + 1) * (1 - kEdgeShare), pixel[x + 1]);
  }
}

bool Painter::several_between(int row, int left, int right) const {
  const std::uint64_t* words =
      buffers_.holds_several.data() + static_cast<std::size_t>(row - bounds_.y0) * words_per_row();
  const int first = left / 64, last = right / 64;
  const std::uint64_t from = ~std::uint64_t{0} << (left % 64), to = ~std::uint64_t{0} >> (63 - right % 64);
  if (first == last) return (words[first] & from & to) != 0;
  if ((words[first] & from) != 0 || (words[last] & to) != 0) return true;
  return std::any_of(words + first + 1, words + last, [](std::uint64_t word) { return word != 0; });
}

template <class Edge>
void Painter::add_lines(const Outline& outline, const LinearPatch& patch, const Edge& edge, int row) {
  const int left = std::max(floor_to_int(outline.left()), bounds_.x0) - bounds_.x0;
  const int right = std::min(floor_to_int(outline.right()), bounds_.x1 - 1) - bounds_.x0;
  if (left > right || !several_between(row, left, right)) return;
  const ExtentPerLine extents = outline.along(row, bounds_.x0 + left);
  const LinearPatch::OnLines plane(patch, row, bounds_.x0 + left);
  const auto integral = [&](const PerLine& from, const PerLine& to, const PerLine& length,
                            const float4& base) {
    if constexpr (std::is_same_v<Edge, NoEdge>) {
      return plane.integral(0.5f * (from + to), length, base);
    } else {
      return edge.integral(row, bounds_.x0 + left, from, to, length, base);
    }
  };
  const std::uint64_t* words =
      buffers_.holds_several.data() + static_cast<std::size_t>(row - bounds_.y0) * words_per_row();
  for (int first = left; first <= right; first = (first / 64 + 1) * 64) {
    std::uint64_t word = words[first / 64] & ~std::uint64_t{0} << (first % 64);
    for (; word != 0; word &= word - 1) {
      const int column = first / 64 * 64 + std::countr_zero(word);
      if (column > right) return;
      const auto begin = static_cast<float>(column - left);
      const PerLine from = max(extents.left, on_all(begin)), to = min(extents.right, on_all(begin + 1));
      const PerLine length = max(to - from, PerLine{}) * (1.0f / kLines);
      if (sum(length) == 0) continue;
      const auto pixel = static_cast<std::size_t>(row_start(bounds_, row) + bounds_.x0 + column);
      add_difference(pixel, integral(from, to, length, base_of(pixel)));
    }
  }
}

// As paint(), of a small triangle: all pixels that it touches are shown by area.
void Painter::paint_by_area(const std::array<ScreenCorner, 3>& corner, const SilhouettePatch& edge) {
  Outline outline(corner);
  const int top = std::max(floor_to_int(outline.top()), bounds_.y0);
  const int bottom = std::min(ceil_to_int(outline.bottom()), bounds_.y1);
  const int left = std::max(floor_to_int(outline.left()), bounds_.x0);
  const int right = std::min(ceil_to_int(outline.right()), bounds_.x1);
  if (top >= bottom || left >= right) return;
  outline.prepare();
  for (int row = top; row < bottom; ++row) {
    add_edge_lines(outline.along(row, left), edge, row, left, right);
    const double center = row + 0.5;
    if (outline.top() <= center && center < outline.bottom()) show_by_area(row, outline.at(center), edge);
  }
}

void Painter::add_edge_lines(const ExtentPerLine& extents, const SilhouettePatch& edge, int row, int left,
                             int right) {
  for (int x = left; x < right; ++x) {
    const auto begin = static_cast<float>(x - left);
    const PerLine from = max(extents.left, on_all(begin)), to = min(extents.right, on_all(begin + 1));
    const PerLine length = max(to - from, PerLine{}) * (1.0f / kLines);
    if (sum(length) == 0) continue;
    const PixelPlace place = place_of(x, row);
    show_by_area(place, edge.beyond());
    add_difference(place.pixel, edge.integral(row, left, from, to, length, base_of(place.pixel)));
  }
}

// The pixels whose centres it holds: a thin triangle may have them between its lines.
void Painter::show_by_area(int row, const Extent& extent, const SilhouettePatch& edge) {
  const int left = std::max(first_center(extent.left), bounds_.x0);
  const int right = std::min(first_center(extent.right), bounds_.x1);
  for (int x = left; x < right; ++x) show_by_area(place_of(x, row), edge.beyond());
}

// From now on, a pixel of about this colour.
void Painter::show_by_area(const PixelPlace& place, const float4& color) {
  ReconstructionBuffers& b = buffers_;
  if ((b.holds_several[place.word] & place.bit) != 0) return;
  if ((b.holds_one[place.word] & place.bit) == 0) store(color, b.sums[place.pixel].base);
  start_sum(place);
}

void Painter::start_sum(const PixelPlace& place) {
  ReconstructionBuffers& b = buffers_;
  b.holds_several[place.word] |= place.bit;
  b.pixels.push_back(static_cast<std::uint32_t>(place.pixel));
  store(float4{0, 0, 0, 1}, b.sums[place.pixel].differences);
}

void Painter::finish() {
  for (const std::uint32_t pixel : buffers_.pixels) {
    const float4 differences = differences_of(pixel);
    const float share = takes_area() ? 1.0f : 1.0f / differences[3];
    store_channels(base_of(pixel) + differences * share, pixels_.colors[pixel]);
  }
}

}  // namespace

PPRT_CLONED_FOR_WIDE_REGISTERS
void reconstruct(const SampleMesh& mesh, const PixelRect& bounds, RegionPixels& pixels,
                 ReconstructionBuffers& buffers, PixelRule rule, ProjectedShapeCache* viewed) {
  pixels.bounds = bounds;
  if (covers_image(mesh)) {
    pixels.colors.resize(pixels.bounds.area());
  } else {
    pixels.colors.assign(pixels.bounds.area(), Color(0, 0, 0));
  }
  const auto& triangles = mesh.triangulation().triangles();
  const Beside is_beside(mesh, bounds);
  Painter painter(pixels, buffers, rule);
  painter.gather(mesh);
  // The small ones with edges first: they decide which pixels the others show by area.
  buffers.edges.assign(triangles.size(), TriangleEdge::kNone);
  SilhouettePatch edge;
  for (std::size_t i = 0; rule == PixelRule::kEdges && viewed && i < triangles.size(); ++i) {
    prefetch_corners(i, mesh);
    const Delaunay::Triangle& t = triangles[i];
    if (!t.is_finite() || !may_show_edge(t, mesh) || is_beside(t)) continue;
    if (!is_small(t, mesh)) {
      buffers.edges[i] = TriangleEdge::kLarge;
      continue;
    }
    const std::array<ScreenCorner, 3> corners = corners_of(t, mesh);
    if (!edge.set(corners, primitives_of(t, mesh), *viewed, 0)) continue;
    buffers.edges[i] = TriangleEdge::kSmall;
    painter.paint_by_area(corners, edge);
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    prefetch_corners(i, mesh);
    const Delaunay::Triangle& t = triangles[i];
    if (!t.is_finite() || buffers.edges[i] == TriangleEdge::kSmall || is_beside(t)) continue;
    const std::array<ScreenCorner, 3> corners = corners_of(t, mesh);
    constexpr float kHalfAPixel = 0.5F;
    if (viewed && buffers.edges[i] == TriangleEdge::kLarge &&
        edge.set(corners, primitives_of(t, mesh), *viewed, kHalfAPixel)) {
      painter.paint(corners, edge);
    } else {
      painter.paint(corners, NoEdge());
    }
  }
  painter.finish();
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
