#include "pipeline/visibility/tile_raster.h"

#include <limits>

#include "pipeline/core/simd.h"
#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {
namespace {

using EightIds = std::uint32_t __attribute__((vector_size(kPoints * sizeof(std::uint32_t))));
using EightNumbers = std::uint16_t __attribute__((vector_size(kPoints * sizeof(std::uint16_t))));

constexpr PerPoint kLanesOfRow = {0, 1, 2, 3, 4, 5, 6, 7};

// A facet's edges are moved outwards by so much, pixels: rounding leaves no gap between neighbours then.
// Forms are floats of points at most 2^12 pixels away. Their rounding is 2^-11 of a pixel.
constexpr float kOverlap = 0x1p-10F;

// Eight points of a row of a tile.
struct Row {
  float* nearest;
  std::uint32_t* numbers;

  void show(int first, const PerPoint& n, std::uint32_t number) {
    const PerPoint before = load<PerPoint>(nearest + first);
    const EightIds ids = load<EightIds>(numbers + first);
    const auto is_nearer = (n > before) | ((n == before) & (EightIds{} + number < ids));
    store(is_nearer ? n : before, nearest + first);
    store(is_nearer ? EightIds{} + number : ids, numbers + first);
  }
};

Row row_of(const TileTarget& to, int row) {
  return {to.nearest + row * kTileStride, to.numbers + row * kTileStride};
}

float row_y(const TileTarget& to, int row) {
  return to.corner.y + to.step * static_cast<float>(row);
}

PerPoint points_x(const TileTarget& to, int first) {
  return (kLanesOfRow + static_cast<float>(first)) * to.step + to.corner.x;
}

// The part of a row in which a quadric's discriminant is not negative. Where that is two parts, all of it.
struct Interval {
  float low, high;
};

Interval within_discriminant(const NearQuadratic& d, float y, const Interval& box) {
  const float square = d.per_xx, half = 0.5F * (d.per_x + d.per_xy * y);
  const float rest = d.constant + y * (d.per_y + d.per_yy * y);
  if (!(square < 0)) return box;
  const float inside = half * half - square * rest;
  if (!(inside > 0)) return {1, 0};
  constexpr float kMargin = 0.25F;  // of rounding: points are tested one by one
  const float root = std::sqrt(inside), per_square = 1 / square;
  return {std::max(box.low, (-half + root) * per_square - kMargin),
          std::min(box.high, (-half - root) * per_square + kMargin)};
}

}  // namespace

PPRT_CLONED_FOR_WIDE_REGISTERS
void rasterise(const ProjectedQuadric& q, std::uint32_t number, const TileTarget& to) {
  const PointSpan rows = to.rows();
  for (int row = rows.begin; row < rows.end; ++row) {
    const float y = row_y(to, row);
    const Interval box = {to.box.x0 + to.corner.x, to.box.x1 + to.corner.x};
    const Interval in = within_discriminant(q.discriminant, y, box);
    const PointSpan span = to.points_within(in.low - to.corner.x, in.high - to.corner.x);
    Row at = row_of(to, row);
    for (int i = span.begin & ~(kPoints - 1); i < span.end; i += kPoints)
      at.show(i, nearness(q, points_x(to, i), PerPoint{} + y), number);
  }
}

// Along a row an edge function is linear, and so is the nearness: the points between the edges need no test.
PPRT_CLONED_FOR_WIDE_REGISTERS
void rasterise(const ProjectedFacet& f, std::uint32_t number, const TileTarget& to) {
  std::array<float, 3> per_edge{}, overlap{};
  for (std::size_t e = 0; e < 3; ++e) {
    per_edge[e] = f.edges[e].per_x != 0 ? 1 / f.edges[e].per_x : 0;
    overlap[e] = kOverlap * (std::fabs(f.edges[e].per_x) + std::fabs(f.edges[e].per_y));
  }
  const PointSpan rows = to.rows();
  for (int row = rows.begin; row < rows.end; ++row) {
    const float y = row_y(to, row);
    float low = to.box.x0 + to.corner.x, high = to.box.x1 + to.corner.x;
    for (std::size_t e = 0; e < 3; ++e) {
      const float at_zero = f.edges[e].constant + f.edges[e].per_y * y + overlap[e];
      const float end = -at_zero * per_edge[e];
      if (f.edges[e].per_x > 0) {
        low = std::max(low, end);
      } else if (f.edges[e].per_x < 0) {
        high = std::min(high, end);
      } else if (at_zero < 0) {
        high = low - 1;
      }
    }
    const PointSpan span = to.points_within(low - to.corner.x, high - to.corner.x);
    Row at = row_of(to, row);
    for (int i = span.begin & ~(kPoints - 1); i < span.end; i += kPoints) {
      const PerPoint place = kLanesOfRow + static_cast<float>(i);
      const auto is_in = (place >= static_cast<float>(span.begin)) & (place < static_cast<float>(span.end));
      at.show(i, is_in ? value(f.nearness, points_x(to, i), PerPoint{} + y) : PerPoint{}, number);
    }
  }
}

bool misses(const ProjectedFacet& f, const TileTarget& to) {
  const float x0 = to.corner.x + std::max(to.box.x0, 0.0F), x1 = to.corner.x + to.box.x1;
  const float y0 = to.corner.y + std::max(to.box.y0, 0.0F), y1 = to.corner.y + to.box.y1;
  return std::any_of(f.edges.begin(), f.edges.end(), [&](const NearLinear& e) {
    const float most =
        e.constant + std::max(e.per_x * x0, e.per_x * x1) + std::max(e.per_y * y0, e.per_y * y1);
    return most < -kOverlap * (std::fabs(e.per_x) + std::fabs(e.per_y));
  });
}

bool DepthBlocks::may_show(float nearest, int x0, int y0, int x1, int y1, const float* points) {
  for (int row = y0 / kSide; row <= y1 / kSide; ++row) {
    for (int column = x0 / kSide; column <= x1 / kSide; ++column) {
      const auto block = static_cast<std::size_t>(row * kBlocks + column);
      if (is_new_[block] != 0) {
        PerPoint least = PerPoint{} + std::numeric_limits<float>::infinity();
        const int rows = row + 1 < kBlocks ? kSide : 1;
        for (int y = 0; y < rows; ++y) {
          const PerPoint at = load<PerPoint>(points + (row * kSide + y) * kTileStride + column * kSide);
          least = at < least ? at : least;
        }
        least_[block] = least[0];
        const int columns = column + 1 < kBlocks ? kSide : 1;
        for (int x = 1; x < columns; ++x) least_[block] = std::min(least_[block], least[x]);
        is_new_[block] = 0;
      }
      if (nearest >= least_[block]) return true;
    }
  }
  return false;
}

void DepthBlocks::touch(int x0, int y0, int x1, int y1) {
  for (int row = y0 / kSide; row <= y1 / kSide; ++row)
    for (int column = x0 / kSide; column <= x1 / kSide; ++column)
      is_new_[static_cast<std::size_t>(row * kBlocks + column)] = 1;
}

PPRT_CLONED_FOR_WIDE_REGISTERS void narrow(const std::uint32_t* from, std::size_t count, std::uint16_t* to) {
  for (std::size_t i = 0; i < count; i += kPoints)
    store(__builtin_convertvector(load<EightIds>(from + i), EightNumbers), to + i);
}

// Along their rows and down their columns no point differs from the next.
PPRT_CLONED_FOR_WIDE_REGISTERS void mark_uniform(const std::uint16_t* numbers, int density,
                                                 std::uint32_t* uniform) {
  const int pixels = kTileIntervals / density;
  for (int p = 0; p < pixels; ++p) {
    std::array<std::uint16_t, kTileIntervals> differ;  // from the point to the right or below, in any row
    for (int i = 0; i < kTileIntervals; i += kPoints) {
      const std::uint16_t* at = numbers + p * density * kTileStride + i;
      EightNumbers all = load<EightNumbers>(at) ^ load<EightNumbers>(at + 1);
      for (int row = 0; row < density; ++row, at += kTileStride) {
        const EightNumbers below = load<EightNumbers>(at + kTileStride);
        all |= (load<EightNumbers>(at) ^ below) | (below ^ load<EightNumbers>(at + kTileStride + 1));
      }
      store(all, differ.data() + i);
    }
    std::uint32_t marks = 0;
    for (int column = 0, i = 0; column < pixels; ++column, i += density) {
      int all = differ[static_cast<std::size_t>(i)] | differ[static_cast<std::size_t>(i + 1)];
      if (density == 4)
        all |= differ[static_cast<std::size_t>(i + 2)] | differ[static_cast<std::size_t>(i + 3)];
      marks |= static_cast<std::uint32_t>(all == 0) << column;
    }
    uniform[p] = marks;
  }
}

}  // namespace pprt
