#include "pipeline/reconstruction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "pipeline/sample_mesh_impl.h"

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

// Where a triangle lies along a row.
struct Extent {
  double left, right;
};

// A triangle's edges, as functions of y. An edge's ends are taken in one fixed order, so that the two
// triangles at it compute the same crossings to the last bit: they neither overlap nor leave gaps.
class Outline {
 public:
  explicit Outline(const std::array<Corner, 3>& corner)
      : top_(corner[0]), middle_(corner[1]), bottom_(corner[2]) {
    const auto swap_if_later = [](End& a, End& b) {
      if (b.y < a.y || (b.y == a.y && b.x < a.x)) std::swap(a, b);
    };
    swap_if_later(top_, middle_);
    swap_if_later(middle_, bottom_);
    swap_if_later(top_, middle_);
    const auto [left, right] = std::minmax({top_.x, middle_.x, bottom_.x});
    left_ = left, right_ = right;
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

 private:
  struct End {
    double x, y;
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
    const auto a = std::clamp(static_cast<float>(ax_ * dx + ay_ * dy), 0.0f, 1.0f);
    const auto b = std::clamp(static_cast<float>(bx_ * dx + by_ * dy), 0.0f, 1.0f);
    return origin_.color + to_1_ * a + to_2_ * b;
  }

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
  // Of a row's lines for the mean over a pixel's area. Along a line the mean is exact.
  static constexpr int kLines = 4;

  std::size_t words_per_row() const { return (static_cast<std::size_t>(bounds_.width()) + 63) / 64; }
  void add_sample(int x, int y, const Color& color);
  void fill(const LinearPatch& patch, int row, const Extent& extent);
  void add_lines(const Outline& outline, const LinearPatch& patch, int row);
  bool several_between(int row, int left, int right) const;
  void add_line(const LinearPatch& patch, int row, double y, const Extent& extent);

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
  for (int line = 0; line < kLines; ++line) {
    const double y = row + (line + 0.5) / kLines;
    if (outline.top() <= y && y < outline.bottom()) add_line(patch, row, y, outline.at(y));
  }
}

void Painter::add_line(const LinearPatch& patch, int row, double y, const Extent& extent) {
  const int left = std::max(floor_to_int(extent.left), bounds_.x0) - bounds_.x0;
  const int right = std::min(floor_to_int(extent.right), bounds_.x1 - 1) - bounds_.x0;
  const std::uint64_t* words =
      buffers_.holds_several.data() + static_cast<std::size_t>(row - bounds_.y0) * words_per_row();
  for (int first = left; first <= right; first = (first / 64 + 1) * 64) {
    std::uint64_t word = words[first / 64] & ~std::uint64_t{0} << (first % 64);
    for (; word != 0; word &= word - 1) {
      const int column = first / 64 * 64 + std::countr_zero(word);
      if (column > right) return;
      const int x = bounds_.x0 + column;
      const double from = std::max<double>(extent.left, x), to = std::min<double>(extent.right, x + 1);
      if (!(from < to)) continue;
      const auto pixel = static_cast<std::size_t>(row_start(bounds_, row) + x);
      const Color difference = patch.at(0.5 * (from + to), y) - buffers_.base[pixel];
      buffers_.sum[pixel] += difference * static_cast<float>((to - from) / kLines);
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
