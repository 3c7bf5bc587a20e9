// Rasterises projected shapes into the points of a tile: how near, and which. Private to the room.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/image_shape.h"
#include "base/vector.h"
#include "pipeline/silhouettes/projected_shape_cache.h"

namespace pprt {

inline constexpr int kTileIntervals = 64;
inline constexpr int kTileStride = kTileIntervals + 8;  // from row to row
inline constexpr std::size_t kTilePlaces = std::size_t{kTileStride} * (kTileIntervals + 1);

// Points in a row of a tile, half-open.
struct PointSpan {
  int begin = 0, end = 0;
};

// Blocks of 8 x 8 points; the last row and column of blocks hold one row and one column of points.
inline constexpr int kBlockSide = 8, kBlocks = kTileIntervals / kBlockSide + 1;

// Blocks of a tile: a bit for each column, row by row.
using BlockSet = std::array<std::uint16_t, kBlocks>;

inline std::size_t count_of(const BlockSet& blocks) {
  std::array<std::uint64_t, 3> words{};
  std::memcpy(words.data(), blocks.data(), sizeof(blocks));
  std::size_t count = 0;
  for (const std::uint64_t word : words) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

// A tile that is rasterised, and where it lies to a shape. Points lie `step` pixels apart; there are
// kTileIntervals + 1 in a row, and kTileStride places.
struct TileTarget {
  float step, per_step;
  Vec2f corner;     // the tile's, from the shape's origin, pixels
  ImageBounds box;  // about the shape within the tile, from the tile's corner, pixels
  float* nearest;
  std::uint32_t* numbers;
  BlockSet blocks;  // in which the shape is shown

  // Returns the points of an interval of coordinates from the tile's corner, pixels.
  PointSpan points_within(float low, float high) const {
    constexpr float kLast = kTileIntervals;
    const float begin = std::min(per_step * std::max(low, 0.0F), kLast + 1);
    const float last = std::max(std::min(per_step * high, kLast), -1.0F) + 1;  // floor(x) is floor(x + 1) - 1
    const int whole = static_cast<int>(begin);
    return {static_cast<float>(whole) < begin ? whole + 1 : whole, static_cast<int>(last)};
  }
  PointSpan columns() const { return points_within(box.x0, box.x1); }
  PointSpan rows() const { return points_within(box.y0, box.y1); }
};

// Shows nothing at any point.
void clear_points(float* nearest, std::uint32_t* numbers);

// Shows a shape at the points where it is nearer than what is there; where it is as near, if its number is
// lower. Returns the blocks whose points may have changed.
BlockSet rasterise(const ProjectedQuadric& q, std::uint32_t number, const TileTarget& to);
BlockSet rasterise(const ProjectedFacet& f, std::uint32_t number, const TileTarget& to);

// Whether an edge of a facet keeps all of it out of a rectangle, from its origin.
bool misses(const ProjectedFacet& f, float x0, float y0, float x1, float y1);

// Whether an edge of a facet keeps all of it out of the tile.
bool misses(const ProjectedFacet& f, const TileTarget& to);

// The least nearness of the points in each block: what is not nearer is hidden there.
class DepthBlocks {
 public:
  void clear() {
    for (auto& row : least_) row.fill(0);
    is_new_.fill(0);
  }

  // Finds the blocks of these points in which a shape may be seen. Returns whether there are any. `nearest`:
  // no point of the shape is nearer.
  bool find_shown(const PointSpan& columns, const PointSpan& rows, const float* points, float nearest,
                  BlockSet& shown);

  // Returns the least nearness of the points in each block, row by row.
  using OfBlocks = std::array<std::array<float, kBlocks>, kBlocks>;
  const OfBlocks& least(const float* points);

  // Points of these blocks have come nearer.
  void touch(const BlockSet& blocks) {
    for (std::size_t row = 0; row < blocks.size(); ++row) is_new_[row] |= blocks[row];
  }

 private:
  OfBlocks least_;
  BlockSet is_new_;
};

// Copies numbers below 2^16; a multiple of eight of them.
void narrow(const std::uint32_t* from, std::size_t count, std::uint16_t* to);

// Marks the pixels whose points have all one number, a bit each: `uniform` has a word for each row of pixels.
// `density`: intervals along a pixel's side.
void mark_uniform(const std::uint16_t* numbers, int density, std::uint32_t* uniform);

}  // namespace pprt
