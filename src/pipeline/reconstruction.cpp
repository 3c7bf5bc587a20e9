#include "pipeline/reconstruction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "pipeline/sample_mesh_impl.h"

// Four lines of doubles fill a register of AVX2: a clone of the function is for hosts that have it, with the
// same results to the bit (docs/decisions/0003-instruction-sets.md). Flat, so that what it calls is cloned
// too.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PPRT_CLONED_FOR_WIDE_REGISTERS [[gnu::flatten, gnu::target_clones("default", "arch=x86-64-v3")]]
#else
#define PPRT_CLONED_FOR_WIDE_REGISTERS
#endif

namespace pprt {
namespace {

struct Corner {
  double x, y;
  Color color;
};

// The largest whole number not above a coordinate, and the smallest not below it: without a call, which is
// what the standard functions cost on the baseline instruction set.
int floor_to_int(double v) {
  const int towards_zero = static_cast<int>(v);
  return towards_zero - (v < towards_zero ? 1 : 0);
}
int ceil_to_int(double v) {
  const int towards_zero = static_cast<int>(v);
  return towards_zero + (v > towards_zero ? 1 : 0);
}

// The first pixel whose centre is at or beyond a coordinate.
int first_center(double coordinate) {
  return ceil_to_int(coordinate - 0.5);
}

// Lines of a row for the mean over a pixel's area, dealt with at once. Along a line the mean is exact.
constexpr int kLines = 4;
using PerLine = float __attribute__((vector_size(kLines * sizeof(float))));
using ExactPerLine = double __attribute__((vector_size(kLines * sizeof(double))));
constexpr PerLine kLineOffsets = {0.125F, 0.375F, 0.625F, 0.875F};  // from the row's beginning

PerLine least(const PerLine& a, const PerLine& b) {
  return a < b ? a : b;
}
PerLine greatest(const PerLine& a, const PerLine& b) {
  return a > b ? a : b;
}
float sum(const PerLine& v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}
PerLine on_all(float value) {
  return PerLine{} + value;
}

// Where a triangle lies along a line.
struct Extent {
  double left, right;
};

struct ExtentPerLine {
  PerLine left, right;
};

// A triangle's edges, as functions of y. An edge's ends are taken in one fixed order, so that the two
// triangles at it compute the same crossings to the last bit: they neither overlap nor leave gaps.
class Outline {
 public:
  explicit Outline(const std::array<Corner, 3>& corner) {
    // Without a branch, for corners come in any order. Of two on one level either may be the upper: the edge
    // between them is never asked for. 3 and 4 cannot be.
    static constexpr std::array<std::array<std::uint8_t, 3>, 8> kDownwards = {
        {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {0, 1, 2}, {0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    const unsigned order = static_cast<unsigned>(corner[1].y < corner[0].y) |
                           static_cast<unsigned>(corner[2].y < corner[1].y) << 1 |
                           static_cast<unsigned>(corner[2].y < corner[0].y) << 2;
    const auto& [top, middle, bottom] = kDownwards[order];
    top_ = corner[top], middle_ = corner[middle], bottom_ = corner[bottom];
    left_ = std::min({top_.x, middle_.x, bottom_.x});
    right_ = std::max({top_.x, middle_.x, bottom_.x});
  }

  double top() const { return top_.y; }
  double bottom() const { return bottom_.y; }
  double left() const { return left_; }
  double right() const { return right_; }

  // To be called before the first at(), once the triangle is known to matter.
  void prepare() {
    whole_ = slope(top_, bottom_);
    upper_ = slope(top_, middle_);
    lower_ = slope(middle_, bottom_);
  }

  // Needs top() <= y < bottom().
  Extent at(double y) const {
    const double a = top_.x + (y - top_.y) * whole_;
    const double b = y < middle_.y ? top_.x + (y - top_.y) * upper_ : middle_.x + (y - middle_.y) * lower_;
    return {std::min(a, b), std::max(a, b)};
  }

  // Along the lines of a pixel row, of no length where they miss the triangle. Coordinates begin at a column,
  // so that float has digits to spare.
  ExtentPerLine along(int row, int column) const {
    const ExactPerLine y = __builtin_convertvector(kLineOffsets, ExactPerLine) + row, below_top = y - top_.y;
    const ExactPerLine a = top_.x + below_top * whole_;
    const ExactPerLine b = y < middle_.y ? top_.x + below_top * upper_ : middle_.x + (y - middle_.y) * lower_;
    const auto meets = (y >= top_.y) & (y < bottom_.y);
    const ExactPerLine begin = ExactPerLine{} + column;
    return {__builtin_convertvector(meets ? (a < b ? a : b) - begin : ExactPerLine{}, PerLine),
            __builtin_convertvector(meets ? (a < b ? b : a) - begin : ExactPerLine{}, PerLine)};
  }

 private:
  struct End {
    double x = 0, y = 0;
    End() = default;
    End(const Corner& corner) : x(corner.x), y(corner.y) {}
  };

  // Horizontal edges are never asked for.
  static double slope(const End& from, const End& to) { return (to.x - from.x) / (to.y - from.y); }

  End top_, middle_, bottom_;
  double left_, right_;
  double whole_ = 0, upper_ = 0, lower_ = 0;
};

// Linear over one triangle: colour = c0 + a (c1 - c0) + b (c2 - c0) with barycentric a, b held to [0, 1], so
// that a constant stays exactly constant and rounding in slivers never leaves the corners' range by more than
// itself.
class LinearPatch {
 public:
  explicit LinearPatch(const std::array<Corner, 3>& corner)
      : origin_(corner[0]),
        to_1_(corner[1].color - corner[0].color),
        to_2_(corner[2].color - corner[0].color) {
    const double x1 = corner[1].x - origin_.x, y1 = corner[1].y - origin_.y;
    const double x2 = corner[2].x - origin_.x, y2 = corner[2].y - origin_.y;
    const double cross = x1 * y2 - y1 * x2;
    const double scale = cross != 0 ? 1 / cross : 0;
    ax_ = y2 * scale, ay_ = -x2 * scale;
    bx_ = -y1 * scale, by_ = x1 * scale;
  }

  Color at(double x, double y) const {
    const double dx = x - origin_.x, dy = y - origin_.y;
    const float a = held_to_unit(static_cast<float>(ax_ * dx + ay_ * dy));
    const float b = held_to_unit(static_cast<float>(bx_ * dx + by_ * dy));
    return origin_.color + to_1_ * a + to_2_ * b;
  }

  // The same along the lines of a pixel row, their coordinates beginning at a column.
  class OnLines {
   public:
    OnLines(const LinearPatch& patch, int row, int column) : patch_(patch) {
      const double dx = column - patch.origin_.x, dy = row - patch.origin_.y;
      a_ = static_cast<float>(patch.ax_ * dx + patch.ay_ * dy) + static_cast<float>(patch.ay_) * kLineOffsets;
      b_ = static_cast<float>(patch.bx_ * dx + patch.by_ * dy) + static_cast<float>(patch.by_) * kLineOffsets;
    }

    // The integral of the difference from `base` over parts of the lines that are so long about x.
    Color integral(const PerLine& x, const PerLine& length, const Color& base) const {
      const auto share = [&](const PerLine& at_column, double slope) {
        const PerLine v = at_column + static_cast<float>(slope) * x;
        return sum(greatest(PerLine{}, least(v, on_all(1))) * length);
      };
      return (patch_.origin_.color - base) * sum(length) + patch_.to_1_ * share(a_, patch_.ax_) +
             patch_.to_2_ * share(b_, patch_.bx_);
    }

   private:
    const LinearPatch& patch_;
    PerLine a_, b_;  // barycentric, at the column
  };

 private:
  Corner origin_;
  Color to_1_, to_2_;
  double ax_, ay_, bx_, by_;
};

std::array<Corner, 3> corners_of(const Delaunay::Triangle& triangle, const SampleMesh::Impl& mesh) {
  const auto corner = [&](std::size_t i) {
    const Delaunay::Index index = triangle.corners[i];
    const Vec2d& point = mesh.delaunay().points()[index];
    return Corner{point.x, point.y, mesh.corners()[index].color};
  };
  return {corner(0), corner(1), corner(2)};
}

// Whether a triangle surely lies beside the bounds.
bool misses(const Delaunay::Triangle& triangle, const SampleMesh::Impl& mesh, const PixelRect& bounds) {
  const Vec2d* points = mesh.delaunay().points().data();
  const auto& [a, b, c] = triangle.corners;
  return std::max({points[a].x, points[b].x, points[c].x}) < bounds.x0 ||
         std::max({points[a].y, points[b].y, points[c].y}) < bounds.y0 ||
         std::min({points[a].x, points[b].x, points[c].x}) > bounds.x1 ||
         std::min({points[a].y, points[b].y, points[c].y}) > bounds.y1;
}

// Where a row of the bounds begins, as if its first pixel were number 0.
std::ptrdiff_t row_start(const PixelRect& bounds, int row) {
  return static_cast<std::ptrdiff_t>(row - bounds.y0) * bounds.width() - bounds.x0;
}

// Calls fill(row, left, right) for the pixel centres of one triangle: in each row those in [left, right).
template <typename Fill>
void for_each_span(const std::array<Corner, 3>& corner, const PixelRect& bounds, const Fill& fill) {
  Outline outline(corner);
  const int top = std::max(first_center(outline.top()), bounds.y0);
  const int bottom = std::min(first_center(outline.bottom()), bounds.y1);
  if (top >= bottom) return;
  outline.prepare();
  for (int row = top; row < bottom; ++row) {
    const Extent extent = outline.at(row + 0.5);
    const int left = std::max(first_center(extent.left), bounds.x0);
    const int right = std::min(first_center(extent.right), bounds.x1);
    if (left < right) fill(row, left, right);
  }
}

// One triangle after another.
class Painter {
 public:
  Painter(RegionPixels& pixels, ReconstructionBuffers& buffers, PixelRule rule)
      : pixels_(pixels), bounds_(pixels.bounds), buffers_(buffers), rule_(rule) {}

  void gather(const SampleMesh::Impl& mesh);
  void paint(const std::array<Corner, 3>& corner);
  void finish();

 private:
  std::size_t words_per_row() const { return (static_cast<std::size_t>(bounds_.width()) + 63) / 64; }
  void add_sample(int x, int y, const Color& color);
  void fill(const LinearPatch& patch, int row, const Extent& extent);
  void add_lines(const Outline& outline, const LinearPatch& patch, int row);
  bool several_between(int row, int left, int right) const;

  RegionPixels& pixels_;
  const PixelRect bounds_;
  ReconstructionBuffers& buffers_;
  PixelRule rule_;
};

// Which pixels hold several samples, and of what colours.
void Painter::gather(const SampleMesh::Impl& mesh) {
  ReconstructionBuffers& b = buffers_;
  b.pixels.clear();
  if (rule_ == PixelRule::kCenter) return;
  for (auto* bits : {&b.holds_one, &b.holds_several})
    bits->assign(words_per_row() * static_cast<std::size_t>(bounds_.height()), 0);
  for (auto* colors : {&b.base, &b.sum}) colors->resize(bounds_.area());
  b.count.resize(bounds_.area());
  const TileGrid& grid = mesh.region().grid();
  const auto& points = mesh.delaunay().points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int x = std::min(static_cast<int>(points[i].x), grid.width - 1);
    const int y = std::min(static_cast<int>(points[i].y), grid.height - 1);
    if (x < bounds_.x0 || x >= bounds_.x1 || y < bounds_.y0 || y >= bounds_.y1) continue;
    add_sample(x, y, mesh.corners()[i].color);
  }
}

void Painter::add_sample(int x, int y, const Color& color) {
  ReconstructionBuffers& b = buffers_;
  const auto pixel = static_cast<std::size_t>(row_start(bounds_, y) + x);
  const auto column = static_cast<std::size_t>(x - bounds_.x0);
  const std::size_t word = static_cast<std::size_t>(y - bounds_.y0) * words_per_row() + column / 64;
  const std::uint64_t bit = std::uint64_t{1} << (column % 64);
  if ((b.holds_one[word] & bit) == 0) {
    b.holds_one[word] |= bit;
    b.base[pixel] = color;
    return;
  }
  if ((b.holds_several[word] & bit) == 0) {
    b.holds_several[word] |= bit;
    b.pixels.push_back(static_cast<std::uint32_t>(pixel));
    b.sum[pixel] = Color(0, 0, 0);
    b.count[pixel] = 1;
  }
  ++b.count[pixel];
  if (rule_ == PixelRule::kMean) b.sum[pixel] += color - b.base[pixel];
}

void Painter::paint(const std::array<Corner, 3>& corner) {
  Outline outline(corner);
  const bool area = rule_ == PixelRule::kArea;
  // Rows that the triangle touches or, where only centres count, whose centres it may hold.
  const int top = std::max(area ? floor_to_int(outline.top()) : first_center(outline.top()), bounds_.y0);
  const int bottom =
      std::min(area ? ceil_to_int(outline.bottom()) : first_center(outline.bottom()), bounds_.y1);
  if (top >= bottom) return;
  outline.prepare();
  const LinearPatch patch(corner);
  for (int row = top; row < bottom; ++row) {
    const double center = row + 0.5;
    if (outline.top() <= center && center < outline.bottom()) fill(patch, row, outline.at(center));
    if (area) add_lines(outline, patch, row);
  }
}

// Evaluates the ends of a span and goes from one to the other: as exact, and needs no care in between.
void Painter::fill(const LinearPatch& patch, int row, const Extent& extent) {
  const int left = std::max(first_center(extent.left), bounds_.x0);
  const int last = std::min(first_center(extent.right), bounds_.x1) - 1;
  if (left > last) return;
  Color* pixel = pixels_.colors.data() + row_start(bounds_, row);
  const Color first = patch.at(left + 0.5, row + 0.5);
  pixel[left] = first;
  if (left == last) return;
  const Color way = patch.at(last + 0.5, row + 0.5) - first;
  const float step = 1.0f / static_cast<float>(last - left);
  for (int x = left + 1; x <= last; ++x) pixel[x] = first + way * (static_cast<float>(x - left) * step);
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

void Painter::add_lines(const Outline& outline, const LinearPatch& patch, int row) {
  const int left = std::max(floor_to_int(outline.left()), bounds_.x0) - bounds_.x0;
  const int right = std::min(floor_to_int(outline.right()), bounds_.x1 - 1) - bounds_.x0;
  if (left > right || !several_between(row, left, right)) return;
  const ExtentPerLine extents = outline.along(row, bounds_.x0 + left);
  const LinearPatch::OnLines plane(patch, row, bounds_.x0 + left);
  const std::uint64_t* words =
      buffers_.holds_several.data() + static_cast<std::size_t>(row - bounds_.y0) * words_per_row();
  for (int first = left; first <= right; first = (first / 64 + 1) * 64) {
    std::uint64_t word = words[first / 64] & ~std::uint64_t{0} << (first % 64);
    for (; word != 0; word &= word - 1) {
      const int column = first / 64 * 64 + std::countr_zero(word);
      if (column > right) return;
      const auto begin = static_cast<float>(column - left);
      const PerLine from = greatest(extents.left, on_all(begin)),
                    to = least(extents.right, on_all(begin + 1));
      const PerLine length = greatest(to - from, PerLine{}) * (1.0f / kLines);
      const auto pixel = static_cast<std::size_t>(row_start(bounds_, row) + bounds_.x0 + column);
      buffers_.sum[pixel] += plane.integral(0.5f * (from + to), length, buffers_.base[pixel]);
    }
  }
}

void Painter::finish() {
  for (const std::uint32_t pixel : buffers_.pixels) {
    const float share = rule_ == PixelRule::kArea ? 1.0f : 1.0f / static_cast<float>(buffers_.count[pixel]);
    pixels_.colors[pixel] = buffers_.base[pixel] + buffers_.sum[pixel] * share;
  }
}

}  // namespace

PPRT_CLONED_FOR_WIDE_REGISTERS
void reconstruct(const SampleMesh& mesh, const PixelRect& bounds, RegionPixels& pixels,
                 ReconstructionBuffers& buffers, PixelRule rule) {
  pixels.bounds = bounds;
  pixels.colors.assign(pixels.bounds.area(), Color(0, 0, 0));
  Painter painter(pixels, buffers, rule);
  painter.gather(mesh.impl());
  for (const Delaunay::Triangle& t : mesh.impl().delaunay().triangles()) {
    if (t.is_finite() && !misses(t, mesh.impl(), bounds)) painter.paint(corners_of(t, mesh.impl()));
  }
  painter.finish();
}

std::vector<std::uint32_t> triangle_at_centers(const SampleMesh& mesh, const PixelRect& bounds) {
  std::vector<std::uint32_t> result(bounds.area(), kNoTriangle);
  std::uint32_t number = 0;
  for (const Delaunay::Triangle& t : mesh.impl().delaunay().triangles()) {
    if (!t.is_finite()) continue;
    for_each_span(corners_of(t, mesh.impl()), bounds, [&](int row, int left, int right) {
      std::uint32_t* pixel = result.data() + row_start(bounds, row);
      std::fill(pixel + left, pixel + right, number);
    });
    ++number;
  }
  return result;
}

}  // namespace pprt
