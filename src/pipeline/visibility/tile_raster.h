// Rasterises projected shapes into the points of a tile: how near, and which. Private to the room.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

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

// A tile that is rasterised, and where it lies to a shape. Points lie `step` pixels apart; there are
// kTileIntervals + 1 in a row, and kTileStride places.
struct TileTarget {
  float step, per_step;
  Vec2f corner;     // the tile's, from the shape's origin, pixels
  ImageBounds box;  // about the shape within the tile, from the tile's corner, pixels
  float* nearest;
  std::uint32_t* numbers;

  // Returns the points of an interval of coordinates from the tile's corner, pixels.
  PointSpan points_within(float low, float high) const {
    constexpr float kLast = kTileIntervals;
    const float first = std::ceil(per_step * std::max(low, 0.0F));
    const float last = std::floor(std::min(per_step * high, kLast));
    return {static_cast<int>(std::min(first, kLast + 1)), static_cast<int>(std::max(last, -1.0F)) + 1};
  }
  PointSpan columns() const { return points_within(box.x0, box.x1); }
  PointSpan rows() const { return points_within(box.y0, box.y1); }
};

// Shows a shape at the points where it is nearer than what is there; where it is as near, if its number is
// lower.
void rasterise(const ProjectedQuadric& q, std::uint32_t number, const TileTarget& to);
void rasterise(const ProjectedFacet& f, std::uint32_t number, const TileTarget& to);

// Whether an edge of a facet keeps all of it out of the tile.
bool misses(const ProjectedFacet& f, const TileTarget& to);

// The least nearness of the points in blocks of 8 x 8: what is not nearer is hidden there.
class DepthBlocks {
 public:
  void clear() { least_.fill(0), is_new_.fill(0); }

  // Whether a shape that is nowhere nearer than `nearest` may be seen in the blocks of these points,
  // inclusive.
  bool may_show(float nearest, int x0, int y0, int x1, int y1, const float* points);

  // The points have come nearer.
  void touch(int x0, int y0, int x1, int y1);

 private:
  static constexpr int kSide = 8, kBlocks = kTileIntervals / kSide + 1;  // the last hold one point

  std::array<float, std::size_t{kBlocks} * kBlocks> least_;
  std::array<std::uint8_t, std::size_t{kBlocks} * kBlocks> is_new_;
};

// Copies numbers below 2^16; a multiple of eight of them.
void narrow(const std::uint32_t* from, std::size_t count, std::uint16_t* to);

// Marks the pixels whose points have all one number, a bit each: `uniform` has a word for each row of pixels.
// `density`: intervals along a pixel's side.
void mark_uniform(const std::uint16_t* numbers, int density, std::uint32_t* uniform);

}  // namespace pprt
