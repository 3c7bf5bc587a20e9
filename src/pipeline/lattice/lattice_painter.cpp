#include "pipeline/lattice/lattice_painter.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

namespace pprt {
namespace {

constexpr int kBasePixels = kBaseSide / kPixelSide;

// Four colours of three channels as they lie in memory.
using PackedColors = std::array<float4, 3>;
static_assert(sizeof(PackedColors) == 4 * sizeof(Color));

PackedColors pack(const std::array<float4, 4>& colors) {
  const auto& [a, b, c, d] = colors;
  return {float4{a[0], a[1], a[2], b[0]}, float4{b[1], b[2], c[0], c[1]}, float4{c[2], d[0], d[1], d[2]}};
}

float4 mean_of(const SquareCorners& corners) {
  return ((corners[0].channels() + corners[1].channels()) + (corners[2].channels() + corners[3].channels())) *
         0.25F;
}

// The bilinear weights of a square's corners at a node.
std::array<float, 4> weights_in(const LatticeNode& corner, int side, const LatticeNode& node) {
  const float per_side = 1 / static_cast<float>(side);
  const float u = static_cast<float>(node.x - corner.x) * per_side;
  const float v = static_cast<float>(node.y - corner.y) * per_side;
  return {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
}

// Returns the image point in the middle of the pixel with this upper left corner.
Vec2d middle_point(const LatticeNode& pixel) {
  return point_of(pixel) + Vec2d(0.5, 0.5);
}

LatticeNode middle_of_pixel(int x, int y) {
  return {kPixelSide * x + kPixelSide / 2, kPixelSide * y + kPixelSide / 2};
}

NodeValue value_of(const Prediction& predicted) {
  return predicted.value;
}

// A colour that other surfaces have a share in tells nothing of its own: it counts for none.
NodeValue value_of_surface(const Prediction& predicted) {
  if (is_of_surface_alone(predicted)) return predicted.value;
  return {predicted.value.channels(), kNoSurface, predicted.value.lights()};
}

}  // namespace

void LatticePainter::paint(const PixelRect& part, PixelBlock& pixels) {
  part_ = part;
  pixels_ = &pixels;
  sees_ = visibility_.is_known();
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
    const bool is_mixed = sees_ && !is_uniform(corner, 1);
    store_channels(is_mixed ? mean_of_mixed(corner, corners) : mean_of_refined(corner, side, corners),
                   pixel(x, y));
    return;
  }
  if (!is_refined(corner, side)) {
    const Square square{corner, side, corners};
    if (sees_ && is_uniform(corner, size)) return paint_uniform(square);
    if (sees_) return paint_mixed(square);
    if (!shows_silhouettes(square)) return fill(corner, side, corners);
    if (size == 2) return paint_silhouettes(square);
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
// quicker, and differences between neighbours do not show. shown_by(Prediction) returns what is taken of it.
template <class ShownBy>
std::array<SquareCorners, 4> LatticePainter::quarters_within_pixel(const LatticeNode& corner, int side,
                                                                   const SquareCorners& corners,
                                                                   const ShownBy& shown_by) {
  const int half = side / 2;
  const LatticeNode center{corner.x + half, corner.y + half};
  const std::array<LatticeNode, 4> middles = {
      {{center.x, corner.y}, {corner.x, center.y}, {corner.x + side, center.y}, {center.x, corner.y + side}}};
  constexpr std::array<std::array<std::size_t, 2>, 4> kEnds = {{{0, 1}, {0, 2}, {1, 3}, {2, 3}}};
  const NodeValue* seen = store_.sample_at(center);
  const std::array<LatticeNode, 4> nodes = nodes_of(corner, side);
  Surroundings around({corner, side, corners});
  std::array<NodeValue, 4> shown;
  for (std::size_t i = 0; i < middles.size(); ++i) {
    if (const NodeValue* sample = store_.sample_at(middles[i])) {
      shown[i] = *sample;
      around.add_middle(shown[i], middles[i], kEnds[i][0], kEnds[i][1]);
      continue;
    }
    Surroundings ends;
    for (const std::size_t end : kEnds[i]) ends.add(corners[end], nodes[end]);
    if (seen != nullptr) ends.add(*seen, center);
    shown[i] = shown_by(predictor_.predict(middles[i], ends));
  }
  const NodeValue inner = seen != nullptr ? *seen : shown_by(predictor_.predict(center, around));
  return {{{corners[0], shown[0], shown[1], inner},
           {shown[0], corners[1], inner, shown[2]},
           {shown[1], inner, corners[2], shown[3]},
           {inner, shown[2], shown[3], corners[3]}}};
}

// A square of whole pixels with samples at its corners only, all of which shows one surface.
void LatticePainter::paint_uniform(const Square& square) {
  surfaces_.begin();
  if (!surfaces_.varies_in(square, seen_at(visibility_, square.corner)))
    return fill(square.corner, square.side, square.corners);
  for_each_pixel(square, [&](int x, int y) {
    const std::uint32_t primitive = visibility_.primitive_in_middle(x, y);
    const Vec2d middle(x + 0.5, y + 0.5);
    store_channels(surfaces_.in_pixel(square, {visibility_.surface_of(primitive), primitive, middle}, middle,
                                      weights_in(square.corner, square.side, middle_of_pixel(x, y))),
                   pixel(x, y));
  });
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
  if (side <= finest_side_ || !is_refined(corner, side)) {
    const Square square{corner, side, corners};
    if (sees_) return surfaces_.mean_over(square);
    if (!shows_silhouettes(square)) return mean_of(corners);
    constexpr std::array<float, 4> kEqual = {0.25F, 0.25F, 0.25F, 0.25F};
    return mean_by_silhouettes(point_of(corner), static_cast<float>(side) / kPixelSide, square, kEqual);
  }
  const int half = side / 2;
  const std::array<SquareCorners, 4> parts = quarters_within_pixel(corner, side, corners, value_of);
  return (mean_of_refined(corner, half, parts[0]) +
          mean_of_refined({corner.x + half, corner.y}, half, parts[1]) +
          mean_of_refined({corner.x, corner.y + half}, half, parts[2]) +
          mean_of_refined({corner.x + half, corner.y + half}, half, parts[3])) *
         0.25F;
}

// Returns the mean over a pixel in which several surfaces are seen: each by its share and by what the samples
// on it show.
float4 LatticePainter::mean_of_mixed(const LatticeNode& corner, const SquareCorners& corners) {
  surfaces_.begin();
  const Square square{corner, kPixelSide, corners};
  if (!is_refined(corner, kPixelSide)) return mixed_mean(corner, square);
  summed_ = 0;
  gather(corner, kPixelSide, corners);
  const Vec2d middle = middle_point(corner);
  constexpr std::array<float, 4> kInTheMiddle = {0.25F, 0.25F, 0.25F, 0.25F};
  float4 mean{};
  for_each_seen(corner, [&](const SeenPrimitive& seen) {
    const auto end = sums_.begin() + static_cast<std::ptrdiff_t>(summed_);
    const auto found =
        std::find_if(sums_.begin(), end, [&](const SurfaceSum& s) { return s.surface == seen.surface; });
    mean += found != end ? found->sum * (seen.share / found->weight)
                         : surfaces_.in_pixel(square, seen, middle, kInTheMiddle) * seen.share;
  });
  return mean;
}

// Sums up by surface what the corners of the smallest squares of a pixel show.
void LatticePainter::gather(const LatticeNode& corner, int side, const SquareCorners& corners) {
  if (side > finest_side_ && is_refined(corner, side)) {
    const int half = side / 2;
    const std::array<SquareCorners, 4> parts = quarters_within_pixel(corner, side, corners, value_of_surface);
    gather(corner, half, parts[0]);
    gather({corner.x + half, corner.y}, half, parts[1]);
    gather({corner.x, corner.y + half}, half, parts[2]);
    gather({corner.x + half, corner.y + half}, half, parts[3]);
    return;
  }
  const auto area = static_cast<float>(side * side);
  for (const NodeValue& value : corners) {
    if (value.surface() == kNoSurface) continue;
    std::size_t i = 0;
    while (i < summed_ && sums_[i].surface != value.surface()) ++i;
    if (i == summed_) {
      if (summed_ == sums_.size()) continue;
      sums_[summed_++] = SurfaceSum{value.surface(), float4{}, 0};
    }
    sums_[i].sum += value.channels() * area, sums_[i].weight += area;
  }
}

// Whether all points of a square of whole pixels see one surface.
bool LatticePainter::is_uniform(const LatticeNode& corner, int pixels) const {
  const int x = corner.x / kPixelSide, y = corner.y / kPixelSide;
  return visibility_.tile(x, y).is_uniform(visibility_.in_tile(x), visibility_.in_tile(y), pixels);
}

// The pixels of a square with samples at its corners only, in which several surfaces are seen.
void LatticePainter::paint_mixed(const Square& square) {
  surfaces_.begin();
  for_each_pixel(square, [&](int x, int y) {
    store_channels(mixed_mean({kPixelSide * x, kPixelSide * y}, square), pixel(x, y));
  });
}

// Returns the mean over a pixel of a square: the surfaces seen in it by their shares, each with its colour in
// the middle.
float4 LatticePainter::mixed_mean(const LatticeNode& corner, const Square& square) {
  const LatticeNode middle = middle_of_pixel(corner.x / kPixelSide, corner.y / kPixelSide);
  const std::array<float, 4> weights = weights_in(square.corner, square.side, middle);
  float4 sum{};
  for_each_seen(corner, [&](const SeenPrimitive& seen) {
    sum += surfaces_.in_pixel(square, seen, middle_point(corner), weights) * seen.share;
  });
  return sum;
}

bool LatticePainter::shows_silhouettes(const Square& square) const {
  return silhouettes_.are_shown() && Surroundings(square).show_edges();
}

// The pixels of a square with samples at its corners only, which lie on several surfaces.
void LatticePainter::paint_silhouettes(const Square& square) {
  for_each_pixel(square, [&](int x, int y) {
    store_channels(mean_by_silhouettes(Vec2d(x, y), 1, square,
                                       weights_in(square.corner, square.side, middle_of_pixel(x, y))),
                   pixel(x, y));
  });
}

// Returns the mean over a part of a square, of at most a pixel: each surface by its share of the part, and
// mostly in the colour of the corners on it. `weights`: those of the corners there.
float4 LatticePainter::mean_by_silhouettes(const Vec2d& corner, float side, const Square& square,
                                           const std::array<float, 4>& weights) {
  const SquareCorners& corners = square.corners;
  float4 mean{};
  for (std::size_t i = 0; i < 4; ++i) mean += corners[i].channels() * weights[i];
  const std::array<std::uint32_t, 4> surfaces = {corners[0].surface(), corners[1].surface(),
                                                 corners[2].surface(), corners[3].surface()};
  const std::optional<std::array<float, 4>> shares = silhouettes_.shares(corner, side, surfaces);
  if (!shares) return mean;
  const int level = errors_.near(square.corner).level;
  float4 difference{};  // from the mean
  for (std::size_t i = 0; i < 4; ++i) {
    if ((*shares)[i] <= 0) continue;
    float4 sum{};
    float weight = 0;
    std::size_t count = 0;
    for (std::size_t k = i; k < 4; ++k) {
      if (surfaces[k] != surfaces[i]) continue;
      sum += corners[k].channels() * weights[k], weight += weights[k], ++count;
    }
    difference += (sum * (1 / weight) - mean) * ((*shares)[i] * share_.of(basis_of(count, 4), level));
  }
  return mean + difference;
}

}  // namespace pprt
