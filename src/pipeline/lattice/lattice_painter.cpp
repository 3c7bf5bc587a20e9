#include "pipeline/lattice/lattice_painter.h"

#include <algorithm>
#include <cstring>

#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {
namespace {

// Points of a square, in shares of its side. No two in one row or column.
constexpr PerPoint kColumns = {0.0625F, 0.1875F, 0.3125F, 0.4375F, 0.5625F, 0.6875F, 0.8125F, 0.9375F};
constexpr PerPoint kRows = {0.4375F, 0.8125F, 0.0625F, 0.6875F, 0.1875F, 0.5625F, 0.9375F, 0.3125F};

constexpr int kBasePixels = kBaseSide / kPixelSide;

float4 weighted_mean(const SquareCorners& corners, const std::array<float, 4>& weights) {
  float4 sum{};
  for (std::size_t i = 0; i < corners.size(); ++i) sum += corners[i].channels() * weights[i];
  return sum;
}

// Four colours of three channels as they lie in memory.
using PackedColors = std::array<float4, 3>;
static_assert(sizeof(PackedColors) == 4 * sizeof(Color));

PackedColors pack(const std::array<float4, 4>& colors) {
  const auto& [a, b, c, d] = colors;
  return {float4{a[0], a[1], a[2], b[0]}, float4{b[1], b[2], c[0], c[1]}, float4{c[2], d[0], d[1], d[2]}};
}

// The eight points of a square that each of up to four shapes is nearest at, as shares.
struct Coverage {
  std::array<float, 4> shares{};
  float all = 0;
};

// Null shapes cover nothing.
PPRT_CLONED_FOR_WIDE_REGISTERS
Coverage coverage(const ProjectedShapeCache& shapes,
                  const std::array<const ProjectedShapeCache::Shape*, 4>& candidates, const Vec2d& corner,
                  float side) {
  const ImageBounds square = {static_cast<float>(corner.x), static_cast<float>(corner.y),
                              static_cast<float>(corner.x) + side, static_cast<float>(corner.y) + side};
  std::array<PerPoint, 4> near{};
  PerPoint nearest{};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i] == nullptr) continue;
    const ProjectedShapeCache::Shape& shape = *candidates[i];
    const PerPoint x = kColumns * side + static_cast<float>(corner.x - shape.origin.x);
    const PerPoint y = kRows * side + static_cast<float>(corner.y - shape.origin.y);
    if (shape.kind == ImageShape::Kind::kQuadric) {
      near[i] = nearness(shape.quadric, x, y);
    } else {
      shapes.for_each_facet(shape, square, [&](const ProjectedFacet& facet) {
        const PerPoint n = nearness(facet, x, y);
        near[i] = n > near[i] ? n : near[i];
      });
    }
    nearest = near[i] > nearest ? near[i] : nearest;
  }
  Coverage found;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const PerPoint is_seen = (near[i] == nearest) & (nearest > 0) ? PerPoint{} + 1.0F / kPoints : PerPoint{};
    found.shares[i] = sum_of(is_seen);
    found.all += found.shares[i];
  }
  return found;
}

}  // namespace

void LatticePainter::paint(const PixelRect& part, PixelBlock& pixels) {
  part_ = part;
  pixels_ = &pixels;
  const auto first = [](int pixel) { return pixel / kBasePixels * kBasePixels; };
  const auto base = [&](int x, int y) { return predictor_.value({kPixelSide * x, kPixelSide * y}); };
  for (int y = first(part.y0); y < part.y1; y += kBasePixels) {
    for (int x = first(part.x0); x < part.x1; x += kBasePixels) {
      const SquareCorners corners = {base(x, y), base(x + kBasePixels, y), base(x, y + kBasePixels),
                                     base(x + kBasePixels, y + kBasePixels)};
      paint_square({kPixelSide * x, kPixelSide * y}, kBaseSide, corners);
    }
  }
}

void LatticePainter::paint_square(const LatticeNode& corner, int side, const SquareCorners& corners) {
  const int x = corner.x / kPixelSide, y = corner.y / kPixelSide, size = side / kPixelSide;
  if (x >= part_.x1 || y >= part_.y1 || x + size <= part_.x0 || y + size <= part_.y0) return;
  if (size == 1) {
    finest_side_ = finest_side(corner);
    store_channels(mean_of_refined(corner, side, corners), pixel(x, y));
    return;
  }
  if (!is_refined(corner, side)) {
    if (is_on_one_primitive(corners) || Surroundings(corners).variance() < kLeastEdgeVariance) {
      fill(corner, side, corners);
      return;
    }
    if (size == 2) {
      paint_edge(corner, corners);
      return;
    }
  }
  const int half = side / 2;
  const std::array<SquareCorners, 4> parts = quarters(corner, side, corners);
  paint_square(corner, half, parts[0]);
  paint_square({corner.x + half, corner.y}, half, parts[1]);
  paint_square({corner.x, corner.y + half}, half, parts[2]);
  paint_square({corner.x + half, corner.y + half}, half, parts[3]);
}

// Whether a sample lies at the centre of a square or in the middle of one of its sides. Without one there is
// none in the square.
bool LatticePainter::is_refined(const LatticeNode& corner, int side) const {
  const int x = corner.x, y = corner.y, half = side / 2;
  const auto any = [&](const auto& is_sampled) {
    return is_sampled({x + half, y + half}) || is_sampled({x + half, y}) || is_sampled({x, y + half}) ||
           is_sampled({x + side, y + half}) || is_sampled({x + half, y + side});
  };
  if (half < kPixelSide) return any([&](const LatticeNode& node) { return store_.is_sampled(node); });
  return any([&](const LatticeNode& node) { return store_.is_corner_sampled(node); });
}

// Returns the side at which no square of a pixel holds samples any more.
int LatticePainter::finest_side(const LatticeNode& pixel) const {
  const int x = pixel.x / kPixelSide, y = pixel.y / kPixelSide;
  if (!store_.has_block(x, y) && !store_.has_block(x + 1, y) && !store_.has_block(x, y + 1))
    return kPixelSide;
  const bool has_cells = store_.has_cells(x, y) || store_.has_cells(x + 1, y) || store_.has_cells(x, y + 1);
  return has_cells ? 1 : LatticeStore::kCellSide;
}

std::array<SquareCorners, 4> LatticePainter::quarters(const LatticeNode& corner, int side,
                                                      const SquareCorners& corners) {
  const auto [x, y] = corner;
  const int half = side / 2;
  const NodeValue center = predictor_.value({x + half, y + half});
  const NodeValue top = predictor_.value({x + half, y}), bottom = predictor_.value({x + half, y + side});
  const NodeValue left = predictor_.value({x, y + half}), right = predictor_.value({x + side, y + half});
  return {{{corners[0], top, left, center},
           {top, corners[1], center, right},
           {left, center, corners[2], bottom},
           {center, right, bottom, corners[3]}}};
}

// The same for a square of at most a pixel. What is not sampled is predicted from this square alone: that is
// quicker, and differences between neighbours do not show.
std::array<SquareCorners, 4> LatticePainter::quarters_within_pixel(const LatticeNode& corner, int side,
                                                                   const SquareCorners& corners) {
  const int half = side / 2;
  const LatticeNode center{corner.x + half, corner.y + half};
  const std::array<LatticeNode, 4> middles = {
      {{center.x, corner.y}, {corner.x, center.y}, {corner.x + side, center.y}, {center.x, corner.y + side}}};
  constexpr std::array<std::array<std::size_t, 2>, 4> kEnds = {{{0, 1}, {0, 2}, {1, 3}, {2, 3}}};
  const NodeValue* seen = store_.sample_at(center);
  Surroundings around(corners);
  std::array<NodeValue, 4> shown;
  for (std::size_t i = 0; i < middles.size(); ++i) {
    if (const NodeValue* sample = store_.sample_at(middles[i])) {
      shown[i] = *sample;
      around.add_middle(shown[i], kEnds[i][0], kEnds[i][1]);
      continue;
    }
    Surroundings ends;
    for (const std::size_t end : kEnds[i]) ends.add(corners[end]);
    if (seen != nullptr) ends.add(*seen);
    shown[i] = predictor_.predict(middles[i], ends);
  }
  const NodeValue inner = seen != nullptr ? *seen : predictor_.predict(center, around);
  return {{{corners[0], shown[0], shown[1], inner},
           {shown[0], corners[1], inner, shown[2]},
           {shown[1], inner, corners[2], shown[3]},
           {inner, shown[2], shown[3], corners[3]}}};
}

// Bilinear: at the centre of a pixel it is the mean over the pixel.
void LatticePainter::fill(const LatticeNode& corner, int side, const SquareCorners& corners) {
  const PixelRect& bounds = pixels_->bounds;
  const int x = corner.x / kPixelSide, y = corner.y / kPixelSide, size = side / kPixelSide;
  const float step = 1.0F / static_cast<float>(size);
  const float4 upper_left = corners[0].channels(), upper_right = corners[1].channels();
  const float4 down_left = (corners[2].channels() - upper_left) * step;
  const float4 down_right = (corners[3].channels() - upper_right) * step;
  const int left = std::max(x, part_.x0), right = std::min(x + size, part_.x1);
  const int top = std::max(y, part_.y0), bottom = std::min(y + size, part_.y1);
  // Down each column a colour changes evenly.
  const float4 down_along = (down_right - down_left) * step, along = (upper_right - upper_left) * step;
  const float first = static_cast<float>(left - x) + 0.5F;
  float4 down = down_left + down_along * first;
  float4 shown = upper_left + along * first + down * (static_cast<float>(top - y) + 0.5F);
  const float4 across = along + down_along * (static_cast<float>(top - y) + 0.5F);
  const auto width = static_cast<std::size_t>(bounds.width());
  Color* pixels = &pixel(left, top);
  int column = left;
  for (; column + 4 <= right; column += 4, pixels += 4) {
    std::array<float4, 4> four, four_down;
    for (std::size_t i = 0; i < 4; ++i) {
      four[i] = shown, four_down[i] = down;
      shown += across, down += down_along;
    }
    PackedColors packed = pack(four);
    const PackedColors packed_down = pack(four_down);
    Color* at = pixels;
    for (int row = top; row < bottom; ++row, at += width) {
      std::memcpy(static_cast<void*>(at), &packed, sizeof packed);
      for (std::size_t i = 0; i < packed.size(); ++i) packed[i] += packed_down[i];
    }
  }
  for (; column < right; ++column, ++pixels) {
    float4 color = shown;
    Color* at = pixels;
    for (int row = top; row < bottom; ++row, at += width) {
      store_channels(color, *at);
      color += down;
    }
    shown += across, down += down_along;
  }
}

// Returns the mean over a pixel or a square of it.
float4 LatticePainter::mean_of_refined(const LatticeNode& corner, int side, const SquareCorners& corners) {
  if (side <= finest_side_ || !is_refined(corner, side)) return mean_of(corner, side, corners);
  const int half = side / 2;
  const std::array<SquareCorners, 4> parts = quarters_within_pixel(corner, side, corners);
  return (mean_of_refined(corner, half, parts[0]) +
          mean_of_refined({corner.x + half, corner.y}, half, parts[1]) +
          mean_of_refined({corner.x, corner.y + half}, half, parts[2]) +
          mean_of_refined({corner.x + half, corner.y + half}, half, parts[3])) *
         0.25F;
}

// Returns the mean over a square with samples at its corners only.
float4 LatticePainter::mean_of(const LatticeNode& corner, int side, const SquareCorners& corners) {
  const Surroundings around(corners);
  if (is_on_one_primitive(corners) || around.variance() < kLeastEdgeVariance) return around.mean();
  return mean_of_edge(corner, side, corners);
}

// The same where the corners lie on different primitives.
float4 LatticePainter::mean_of_edge(const LatticeNode& corner, int side, const SquareCorners& corners) {
  const Surroundings around(corners);
  const EdgeShapes shapes = shapes_of(corner, corners);
  constexpr std::array<float, 4> kEqual = {0.25F, 0.25F, 0.25F, 0.25F};
  if (!shapes.are_known) return around.mean();
  const float share = share_.of(around.primitives(), errors_.near(corner).level);
  return mean_by_shapes(point_of(corner), static_cast<float>(side) / kPixelSide, corners, shapes, kEqual,
                        share);
}

// The four pixels of a square whose corners lie on different primitives and that holds no other sample. In
// each pixel the corners count by their distance.
void LatticePainter::paint_edge(const LatticeNode& corner, const SquareCorners& corners) {
  constexpr float kNear = 0.75F, kFar = 0.25F;
  const EdgeShapes shapes = shapes_of(corner, corners);
  const float share = share_.of(Surroundings(corners).primitives(), errors_.near(corner).level);
  for (std::size_t p = 0; p < 4; ++p) {
    const LatticeNode at{corner.x + static_cast<int>(p % 2) * kPixelSide,
                         corner.y + static_cast<int>(p / 2) * kPixelSide};
    const int x = at.x / kPixelSide, y = at.y / kPixelSide;
    if (x < part_.x0 || y < part_.y0 || x >= part_.x1 || y >= part_.y1) continue;
    std::array<float, 4> weights{};
    for (std::size_t i = 0; i < 4; ++i)
      weights[i] = (i % 2 == p % 2 ? kNear : kFar) * (i / 2 == p / 2 ? kNear : kFar);
    store_channels(shapes.are_known ? mean_by_shapes(point_of(at), 1, corners, shapes, weights, share)
                                    : weighted_mean(corners, weights),
                   pixel(x, y));
  }
}

// The shapes of the corners' primitives, as seen near the square.
LatticePainter::EdgeShapes LatticePainter::shapes_of(const LatticeNode& corner,
                                                     const SquareCorners& corners) {
  EdgeShapes found;
  const Surroundings around(corners);
  std::array<ProjectedShapeCache::Place, 4> places{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!around.is_first(i) || corners[i].primitive() == 0) continue;
    places[i] = shapes_.find(corners[i].primitive(), point_of(corner));
    if (shapes_.shape(places[i]).kind == ImageShape::Kind::kUnknown) return found;
  }
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (places[i] != ProjectedShapeCache::Place{0}) found.shapes[i] = &shapes_.shape(places[i]);
  found.are_known = true;
  return found;
}

// Returns the mean over a square of at most a pixel, of weighted colours: where a shape is seen, mostly those
// of the corners on its primitive.
float4 LatticePainter::mean_by_shapes(const Vec2d& at, float size, const SquareCorners& corners,
                                      const EdgeShapes& shapes, const std::array<float, 4>& weights,
                                      float share) {
  const Coverage found = coverage(shapes_, shapes.shapes, at, size);
  const float each = 1 / std::max(found.all, 1.0F), beyond = std::max(1 - found.all, 0.0F);
  const float4 mean = weighted_mean(corners, weights);
  float4 difference{};  // from the mean
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t primitive = corners[i].primitive();
    const auto is_before = [&](const SquareCorners::value_type& v) { return v.primitive() == primitive; };
    if (std::any_of(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(i), is_before)) continue;
    const float covered = primitive == 0 ? beyond : found.shares[i] * each;
    if (covered <= 0) continue;
    float4 sum{};
    float weight = 0;
    for (std::size_t k = i; k < corners.size(); ++k) {
      if (corners[k].primitive() == primitive)
        sum += corners[k].channels() * weights[k], weight += weights[k];
    }
    difference += (sum * (1 / weight) - mean) * covered;
  }
  return mean + difference * share;
}

}  // namespace pprt
