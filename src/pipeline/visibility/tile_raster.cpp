#include "pipeline/visibility/tile_raster.h"

#include <bit>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/simd.h"
#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {
namespace {

using EightIds = std::uint32_t __attribute__((vector_size(kPoints * sizeof(std::uint32_t))));
using EightInts = std::int32_t __attribute__((vector_size(kPoints * sizeof(std::int32_t))));
using FourWords = std::uint64_t __attribute__((vector_size(kPoints * sizeof(std::uint32_t))));
using EightNumbers = std::uint16_t __attribute__((vector_size(kPoints * sizeof(std::uint16_t))));

constexpr PerPoint kLanesOfRow = {0, 1, 2, 3, 4, 5, 6, 7};

// A facet's edges are moved outwards by so much, pixels: rounding leaves no gap between neighbours then.
// Forms are floats of points at most 2^12 pixels away. Their rounding is 2^-11 of a pixel.
constexpr float kOverlap = 0x1p-10F;

// Rounds towards zero numbers that an int holds.
PerPoint whole_part(const PerPoint& v) {
  return __builtin_convertvector(__builtin_convertvector(v, EightInts), PerPoint);
}

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

// The row or column of blocks that a row or column of points lies in.
static_assert(kBlockSide == kPoints);
std::size_t block_of(int point) {
  return static_cast<std::size_t>(point / kBlockSide);
}

float row_y(const TileTarget& to, int row) {
  return to.corner.y + to.step * static_cast<float>(row);
}

PerPoint points_x(const TileTarget& to, int first) {
  return (kLanesOfRow + static_cast<float>(first)) * to.step + to.corner.x;
}

// The points of eight rows, half-open: as TileTarget::points_within() finds them in one.
struct SpansOfRows {
  PerPoint begin, end;
};

SpansOfRows spans_within(const PerPoint& low, const PerPoint& high, const TileTarget& to) {
  constexpr float kLast = kTileIntervals;
  const PerPoint least{}, most = least + (kLast + 1), last = least + kLast, before = least - 1;
  PerPoint begin = to.per_step * (low > 0 ? low : least), end = to.per_step * high;
  begin = begin < most ? begin : most;
  end = end < last ? end : last;
  end = end > before ? end : before;
  const PerPoint whole = whole_part(begin);
  return {whole < begin ? whole + 1 : whole, whole_part(end + 1)};
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

// Returns a bit for each word of a row's numbers: whether all of them are 0. Words: eight or four in a
// vector.
template <class Words>
std::uint32_t zero_words(const std::array<std::uint16_t, kTileIntervals>& numbers) {
  using Word = std::remove_cvref_t<decltype(Words{}[0])>;
  constexpr int kWords = sizeof(Words) / sizeof(Word);
  Words bit{}, found{};
  for (int i = 0; i < kWords; ++i) bit[i] = Word{1} << i;
  for (std::size_t i = 0; i < numbers.size(); i += sizeof(Words) / sizeof(numbers[0]), bit <<= kWords)
    found |= load<Words>(numbers.data() + i) == 0 ? bit : Words{};
  Word all = 0;
  for (int i = 0; i < kWords; ++i) all |= found[i];
  return static_cast<std::uint32_t>(all);
}

// Returns the least nearness of the points in a block.
float least_of(std::size_t row, std::size_t column, const float* points) {
  PerPoint least = PerPoint{} + std::numeric_limits<float>::infinity();
  const float* at = points + (row * kTileStride + column) * kBlockSide;
  const int rows = row + 1 < kBlocks ? kBlockSide : 1, columns = column + 1 < kBlocks ? kBlockSide : 1;
  for (int y = 0; y < rows; ++y, at += kTileStride) {
    const PerPoint here = load<PerPoint>(at);
    least = here < least ? here : least;
  }
  float found = least[0];
  for (int x = 1; x < columns; ++x) found = std::min(found, least[x]);
  return found;
}

}  // namespace

void clear_points(float* nearest, std::uint32_t* numbers) {
  for (int row = 0; row <= kTileIntervals; ++row, nearest += kTileStride, numbers += kTileStride) {
    std::fill_n(nearest, kTileStride, 0.0F);
    std::fill_n(numbers, kTileStride, 0U);
  }
}

PPRT_CLONED_FOR_WIDE_REGISTERS
BlockSet rasterise(const ProjectedQuadric& q, std::uint32_t number, const TileTarget& to) {
  BlockSet changed{};
  const PointSpan rows = to.rows();
  for (int row = rows.begin; row < rows.end; ++row) {
    const unsigned blocks = to.blocks[block_of(row)];
    if (blocks == 0) continue;
    const float y = row_y(to, row);
    const Interval box = {to.box.x0 + to.corner.x, to.box.x1 + to.corner.x};
    const Interval in = within_discriminant(q.discriminant, y, box);
    const PointSpan span = to.points_within(in.low - to.corner.x, in.high - to.corner.x);
    Row at = row_of(to, row);
    unsigned met = 0;
    for (int i = span.begin & ~(kPoints - 1); i < span.end; i += kPoints) {
      const unsigned block = blocks & 1U << block_of(i);
      if (block == 0) continue;
      at.show(i, nearness(q, points_x(to, i), PerPoint{} + y), number);
      met |= block;
    }
    changed[block_of(row)] |= static_cast<std::uint16_t>(met);
  }
  return changed;
}

// Along a row an edge function is linear, and so is the nearness: the points between the edges need no test.
// The ends of eight rows are found at once, for slivers leave most rows of a tile empty.
PPRT_CLONED_FOR_WIDE_REGISTERS
BlockSet rasterise(const ProjectedFacet& f, std::uint32_t number, const TileTarget& to) {
  std::array<float, 3> per_edge{}, overlap{};
  for (std::size_t e = 0; e < 3; ++e) {
    per_edge[e] = f.edges[e].per_x != 0 ? 1 / f.edges[e].per_x : 0;
    overlap[e] = kOverlap * (std::fabs(f.edges[e].per_x) + std::fabs(f.edges[e].per_y));
  }
  BlockSet changed{};
  const PointSpan rows = to.rows();
  for (int first = rows.begin & ~(kPoints - 1); first < rows.end; first += kPoints) {
    const unsigned blocks = to.blocks[block_of(first)];
    if (blocks == 0) continue;
    unsigned met = 0;
    const PerPoint y = (kLanesOfRow + static_cast<float>(first)) * to.step + to.corner.y;
    PerPoint low = PerPoint{} + (to.box.x0 + to.corner.x), high = PerPoint{} + (to.box.x1 + to.corner.x);
    for (std::size_t e = 0; e < 3; ++e) {
      const PerPoint at_zero = f.edges[e].constant + f.edges[e].per_y * y + overlap[e];
      const PerPoint end = -at_zero * per_edge[e];
      if (f.edges[e].per_x > 0) {
        low = low < end ? end : low;
      } else if (f.edges[e].per_x < 0) {
        high = end < high ? end : high;
      } else {
        high = at_zero < 0 ? low - 1 : high;
      }
    }
    const SpansOfRows spans = spans_within(low - to.corner.x, high - to.corner.x, to);
    for (int row = std::max(first, rows.begin); row < std::min(first + kPoints, rows.end); ++row) {
      const float begin = spans.begin[row - first], end = spans.end[row - first];
      Row at = row_of(to, row);
      for (int i = static_cast<int>(begin) & ~(kPoints - 1); static_cast<float>(i) < end; i += kPoints) {
        const unsigned block = blocks & 1U << block_of(i);
        if (block == 0) continue;
        const PerPoint place = kLanesOfRow + static_cast<float>(i);
        const auto is_in = (place >= begin) & (place < end);
        const PerPoint n = value(f.nearness, points_x(to, i), PerPoint{} + row_y(to, row));
        at.show(i, is_in ? n : PerPoint{}, number);
        met |= block;
      }
    }
    changed[block_of(first)] = static_cast<std::uint16_t>(met);
  }
  return changed;
}

bool misses(const ProjectedFacet& f, float x0, float y0, float x1, float y1) {
  return std::any_of(f.edges.begin(), f.edges.end(), [&](const NearLinear& e) {
    const float most =
        e.constant + std::max(e.per_x * x0, e.per_x * x1) + std::max(e.per_y * y0, e.per_y * y1);
    return most < -kOverlap * (std::fabs(e.per_x) + std::fabs(e.per_y));
  });
}

bool misses(const ProjectedFacet& f, const TileTarget& to) {
  return misses(f, to.corner.x + std::max(to.box.x0, 0.0F), to.corner.y + std::max(to.box.y0, 0.0F),
                to.corner.x + to.box.x1, to.corner.y + to.box.y1);
}

PPRT_CLONED_FOR_WIDE_REGISTERS
const DepthBlocks::OfBlocks& DepthBlocks::least(const float* points) {
  for (std::size_t row = 0; row < kBlocks; ++row) {
    for (unsigned columns = std::exchange(is_new_[row], std::uint16_t{0}); columns != 0;
         columns &= columns - 1) {
      const auto column = static_cast<std::size_t>(std::countr_zero(columns));
      least_[row][column] = least_of(row, column, points);
    }
  }
  return least_;
}

PPRT_CLONED_FOR_WIDE_REGISTERS
bool DepthBlocks::find_shown(const PointSpan& columns, const PointSpan& rows, const float* points,
                             float nearest, BlockSet& shown) {
  shown.fill(0);
  const auto first_column = static_cast<std::size_t>(columns.begin / kBlockSide);
  const auto last_column = static_cast<std::size_t>((columns.end - 1) / kBlockSide);
  const auto last_row = static_cast<std::size_t>((rows.end - 1) / kBlockSide);
  unsigned any = 0;
  for (auto row = static_cast<std::size_t>(rows.begin / kBlockSide); row <= last_row; ++row) {
    unsigned found = 0;
    for (std::size_t column = first_column; column <= last_column; ++column) {
      if ((is_new_[row] >> column & 1U) != 0) least_[row][column] = least_of(row, column, points);
      found |= static_cast<unsigned>(nearest >= least_[row][column]) << column;
    }
    is_new_[row] &= static_cast<std::uint16_t>(~((2U << last_column) - (1U << first_column)));
    shown[row] = static_cast<std::uint16_t>(found);
    any |= found;
  }
  return any != 0;
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
    uniform[p] = density == 2 ? zero_words<EightIds>(differ) : zero_words<FourWords>(differ);
  }
}

}  // namespace pprt
