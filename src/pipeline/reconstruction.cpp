#include "pipeline/reconstruction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pipeline/sample_mesh_impl.h"

namespace pprt {
namespace {

struct Corner {
  double x, y;
  Color color;
};

// Where an edge crosses a row of pixel centres. The ends are taken in one fixed order, so that the two
// triangles at an edge compute the same number to the last bit and every centre falls to exactly one of them.
double crossing(const Corner& a, const Corner& b, double y) {
  const bool ordered = a.y < b.y || (a.y == b.y && a.x < b.x);
  const Corner& low = ordered ? a : b;
  const Corner& high = ordered ? b : a;
  return low.x + (y - low.y) * ((high.x - low.x) / (high.y - low.y));
}

// The first pixel whose centre is at or beyond a coordinate.
int first_center(double coordinate) {
  return static_cast<int>(std::ceil(coordinate - 0.5));
}

// Linear over one triangle: colour = c0 + a (c1 - c0) + b (c2 - c0) with barycentric a, b held to [0, 1], so
// that a constant stays exactly constant and rounding in slivers never leaves the corners' range by more than
// itself.
class LinearPatch {
 public:
  LinearPatch(const Corner& c0, const Corner& c1, const Corner& c2)
      : origin_(c0), to_1_(c1.color - c0.color), to_2_(c2.color - c0.color) {
    const double x1 = c1.x - c0.x, y1 = c1.y - c0.y, x2 = c2.x - c0.x, y2 = c2.y - c0.y;
    const double cross = x1 * y2 - y1 * x2;
    const double scale = cross != 0 ? 1 / cross : 0;
    ax_ = y2 * scale, ay_ = -x2 * scale;
    bx_ = -y1 * scale, by_ = x1 * scale;
  }

  void fill(int x0, int x1, double y, Color* row) const {
    const double dy = y - origin_.y;
    for (int x = x0; x < x1; ++x) {
      const double dx = x + 0.5 - origin_.x;
      const auto a = std::clamp(static_cast<float>(ax_ * dx + ay_ * dy), 0.0f, 1.0f);
      const auto b = std::clamp(static_cast<float>(bx_ * dx + by_ * dy), 0.0f, 1.0f);
      row[x] = origin_.color + to_1_ * a + to_2_ * b;
    }
  }

 private:
  Corner origin_;
  Color to_1_, to_2_;
  double ax_, ay_, bx_, by_;
};

// Rows of pixels, half-open.
struct Rows {
  int top = 0, bottom = 0;
};

// Those within `bounds` whose centres a triangle may hold: none when it lies between centres or beside the
// bounds.
Rows rows_of(const std::array<Corner, 3>& corner, const PixelRect& bounds) {
  const auto [min_y, max_y] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
  const Rows rows{std::max(first_center(min_y), bounds.y0), std::min(first_center(max_y), bounds.y1)};
  if (rows.top >= rows.bottom) return {};
  const auto [min_x, max_x] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
  if (std::max(first_center(min_x), bounds.x0) >= std::min(first_center(max_x), bounds.x1)) return {};
  return rows;
}

// Calls fill(row, left, right) for the pixel centres of one triangle: in each row those in [left, right).
template <typename Fill>
void for_each_span(const std::array<Corner, 3>& corner, const Rows& rows, const PixelRect& bounds,
                   const Fill& fill) {
  for (int row = rows.top; row < rows.bottom; ++row) {
    const double y = row + 0.5;
    // Exactly two of the three edges cross the row: those whose ends lie on different sides of it.
    std::array<double, 2> ends{};
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3 && found < 2; ++i) {
      const Corner& a = corner[i];
      const Corner& b = corner[(i + 1) % 3];
      if ((a.y <= y) != (b.y <= y)) ends[found++] = crossing(a, b, y);
    }
    if (found < 2) continue;
    const int left = std::max(first_center(std::min(ends[0], ends[1])), bounds.x0);
    const int right = std::min(first_center(std::max(ends[0], ends[1])), bounds.x1);
    if (left < right) fill(row, left, right);
  }
}

// Where a row of the bounds begins, as if its first pixel were number 0.
std::ptrdiff_t row_start(const PixelRect& bounds, int row) {
  return static_cast<std::ptrdiff_t>(row - bounds.y0) * bounds.width() - bounds.x0;
}

template <typename Face>
std::array<Corner, 3> corners_of(const Face& face) {
  std::array<Corner, 3> corner;
  for (int i = 0; i < 3; ++i) {
    const auto& vertex = *face->vertex(i);
    corner[static_cast<std::size_t>(i)] = {vertex.point().x(), vertex.point().y(), vertex.info().color};
  }
  return corner;
}

void fill_triangle(const std::array<Corner, 3>& corner, RegionPixels& pixels) {
  const Rows rows = rows_of(corner, pixels.bounds);
  if (rows.top >= rows.bottom) return;
  const LinearPatch patch(corner[0], corner[1], corner[2]);
  for_each_span(corner, rows, pixels.bounds, [&](int row, int left, int right) {
    patch.fill(left, right, row + 0.5, pixels.colors.data() + row_start(pixels.bounds, row));
  });
}

// The average rule: where more than one sample falls in a pixel, their mean replaces the interpolation.
void average_crowded_pixels(const SampleMesh& mesh, RegionPixels& pixels, ReconstructionBuffers& buffers) {
  const PixelRect& bounds = pixels.bounds;
  buffers.sums.assign(pixels.colors.size(), Color(0, 0, 0));
  buffers.counts.assign(pixels.colors.size(), 0);
  const TileGrid& grid = mesh.region().grid();
  for (const Sample& sample : mesh.samples()) {
    const int x = std::min(static_cast<int>(sample.x), grid.width - 1);
    const int y = std::min(static_cast<int>(sample.y), grid.height - 1);
    if (x < bounds.x0 || x >= bounds.x1 || y < bounds.y0 || y >= bounds.y1) continue;
    const std::size_t i = static_cast<std::size_t>(y - bounds.y0) * static_cast<std::size_t>(bounds.width()) +
                          static_cast<std::size_t>(x - bounds.x0);
    buffers.sums[i] += sample.ray.color;
    ++buffers.counts[i];
  }
  for (std::size_t i = 0; i < pixels.colors.size(); ++i) {
    if (buffers.counts[i] > 1) pixels.colors[i] = buffers.sums[i] / static_cast<float>(buffers.counts[i]);
  }
}

}  // namespace

void reconstruct(const SampleMesh& mesh, const PixelRect& bounds, RegionPixels& pixels,
                 ReconstructionBuffers& buffers, CrowdedPixels crowded) {
  pixels.bounds = bounds;
  pixels.colors.assign(pixels.bounds.area(), Color(0, 0, 0));
  const auto& delaunay = mesh.impl().delaunay();
  for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
    fill_triangle(corners_of(face), pixels);
  }
  if (crowded == CrowdedPixels::kMean) average_crowded_pixels(mesh, pixels, buffers);
}

std::vector<std::uint32_t> triangle_at_centers(const SampleMesh& mesh, const PixelRect& bounds) {
  std::vector<std::uint32_t> result(bounds.area(), kNoTriangle);
  const auto& delaunay = mesh.impl().delaunay();
  std::uint32_t number = 0;
  for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face, ++number) {
    const std::array<Corner, 3> corner = corners_of(face);
    for_each_span(corner, rows_of(corner, bounds), bounds, [&](int row, int left, int right) {
      std::uint32_t* pixel = result.data() + row_start(bounds, row);
      std::fill(pixel + left, pixel + right, number);
    });
  }
  return result;
}

}  // namespace pprt
