// What is seen at each point of a picture: the nearest primitive, found by rasterising projected shapes.
//
// Points lie a half or a quarter of a pixel apart, pixels' corners among them, in tiles of 64 x 64 intervals.
// A tile is rasterised when it is asked for first: its depths then stay in the first cache. Source: a
// visibility buffer, as in Burns and Hunt, "The Visibility Buffer: A Cache-Friendly Approach to Deferred
// Shading", JCGT 2013; quadrics as in Sigg et al., "GPU-Based Ray-Casting of Quadratic Surfaces", 2006.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/image_shape.h"
#include "base/vector.h"
#include "pipeline/core/tile_grid.h"
#include "pipeline/silhouettes/projected_shape_cache.h"
#include "pipeline/visibility/pixel_lines.h"
#include "pipeline/visibility/tile_raster.h"

namespace pprt {

// What is seen in a pixel: primitives by their tile's own numbers, the share of each, and where it is.
struct SeenInPixel {
  static constexpr std::size_t kMost = 64;

  std::array<std::uint16_t, kMost> numbers;
  std::array<float, kMost> shares;  // of the area
  std::array<Vec2f, kMost> places;  // the middle of its points, pixels from the corner
  std::size_t count = 0;
};

// What is seen of a tile: at each point a number of the tile's own, by which its primitives are listed, and
// the surfaces that these are parts of.
class VisibleTile {
 public:
  // Returns the surface at a point, counted from the tile's corner; 0: the background.
  std::uint32_t at(int x, int y) const { return surfaces_[row(y)[x]]; }

  // Returns the own numbers of a row of points. The background's is 0.
  const std::uint16_t* row(int y) const { return points_.data() + static_cast<std::size_t>(y * kTileStride); }

  // By the own numbers: the surfaces, and the first number of the same surface.
  std::span<const std::uint32_t> surfaces() const { return surfaces_; }
  std::span<const std::uint16_t> first_of_surface() const { return first_of_surface_; }

  // Returns the primitive of an own number.
  std::uint32_t primitive(std::uint16_t number) const { return primitives_[number]; }

  // Whether all points of a square are on one surface, its border included. Corner and side are whole
  // pixels.
  bool is_uniform(int pixel_x, int pixel_y, int pixels) const {
    const std::uint32_t columns = (pixels < 32 ? (1U << pixels) - 1 : ~0U) << pixel_x;
    std::uint32_t all = columns;
    for (int y = pixel_y; y < pixel_y + pixels; ++y) all &= uniform_[static_cast<std::size_t>(y)];
    return all == columns;
  }

 private:
  friend class VisibilityBuffer;

  std::array<std::uint16_t, kTilePlaces> points_;
  std::array<std::uint32_t, 32> uniform_;  // pixels of a row of pixels, a bit each
  std::vector<std::uint32_t> primitives_, surfaces_;
  std::vector<std::uint16_t> first_of_surface_;
  std::vector<std::uint32_t> items_;       // by primitive: their numbers in VisibilityBuffer::items_
  std::vector<std::uint32_t> first_item_;  // of each primitive, in items_

  // What may pass between the points of a block whose pixels do not all see one surface.
  struct InBlock {
    std::uint32_t item;
    std::uint16_t number;  // of its primitive
  };
  static constexpr std::size_t kBlocksOfPixels = kTileIntervals / kBlockSide;
  std::vector<InBlock> in_blocks_;  // block by block
  std::array<std::uint32_t, kBlocksOfPixels * kBlocksOfPixels + 1> first_in_block_;
};

// The shapes of a scene's primitives, numbered from 1 to `count`, as Probe::project makes them. None: nothing
// can be known of what is seen.
struct PrimitiveShapes {
  ProjectedShapeCache::View project = {};
  std::uint32_t count = 0;
  std::span<const std::uint32_t> surfaces = {};
  // Bounds them, as Probe::bound. Empty: their projections do.
  std::function<void(std::uint32_t first, std::span<ShapeBounds> bounds)> bound = {};

  // Primitives from other ranks may have any number.
  std::uint32_t surface_of(std::uint32_t primitive) const {
    return primitive < surfaces.size() ? surfaces[primitive] : primitive;
  }
};

// What seeing is expected to take, in rays. Quadrics and facets beyond those that were seen have a price of
// their own: what few large ones took says nothing of many.
struct SeeingPrice {
  double each = 0;                                             // of those seen
  std::size_t seen = std::numeric_limits<std::size_t>::max();  // how many were
  double further = 0;                                          // of each beyond

  double of(std::size_t items) const {
    const std::size_t known = std::min(items, seen);
    return each * static_cast<double>(known) + further * static_cast<double>(items - known);
  }
};

class VisibilityBuffer {
 public:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  // For the points (0, 0) to (right, bottom), pixels.
  VisibilityBuffer(int right, int bottom, PrimitiveShapes shapes);

  // How fine it is. Little is seen of finer edges where samples are few.
  struct Fineness {
    int points_per_side;  // of a pixel
    int share_lines;      // across a pixel, for shares()
    int share_points;     // in it, where lines cannot tell
    bool has_thin;        // what passes between points has a share, too

    friend bool operator==(const Fineness&, const Fineness&) = default;
  };
  static constexpr Fineness kCoarse = {2, 8, 32, false}, kMiddle = {2, 8, 64, true},
                            kFine = {4, 16, 128, true};

  // The eye or what it sees has moved: all is to be seen anew.
  void forget(const Fineness& fineness);
  void forget() { forget(fineness()); }

  // The shares of what is seen in a pixel are as fine as can be from now on.
  void refine_shares() { share_lines_ = 32, share_points_ = 256; }

  // Counts as not known where seeing would take longer than so many rays. All primitives are bounded for it,
  // and each quadric and facet that may be in a part of the picture has its price. 0 rays: nothing is even
  // bounded.
  void limit(double rays, const SeeingPrice& price, const PixelRect& within) {
    state_ = rays > 0 && has_shapes() ? State::kNotAsked : State::kUnknown;
    most_rays_ = rays, price_ = price, within_ = within;
  }
  void limit(double rays) { limit(rays, {}, {0, 0, right_, bottom_}); }

  // Returns how many quadrics and facets limit() counted in its part of the picture.
  std::size_t items_within() const { return items_within_; }

  // Returns what seeing took, in rays, without bounding. It is of what is known, or was until it was
  // forgotten. Counts are the same everywhere: of what was projected, tried in tiles, and rasterised in
  // blocks of 8 x 8 points. With 1,000 instructions a ray they are .76 to 1.2 of those of the nine databases,
  // where listing by block takes up to a fifth more. A sample of the tree has 10,000, with ten rays by
  // LatticeRefiner's count.
  double work() const {
    constexpr double kFacet = 2.5, kQuadric = 1.5, kTrial = 1.2, kTile = 14;
    constexpr double kFacetBlock = 0.4, kQuadricBlock = 1.1;
    const auto of = [](double price, std::size_t count) { return price * static_cast<double>(count); };
    return of(kFacet, facets_.size()) + of(kQuadric, quadrics_.size()) + of(kTrial, trials_) +
           of(kTile, tiles_seen_) + of(kFacetBlock, facet_blocks_) + of(kQuadricBlock, quadric_blocks_);
  }

  // Returns what it takes to bound all primitives, in rays. Most are out of view, with others.
  double bounding() const {
    constexpr double kRaysOfABound = 0.13;
    return shapes_.bound ? kRaysOfABound * static_cast<double>(shapes_.count) : 0;
  }

  // Returns how many pixels of the tiles seen so far show several surfaces.
  std::size_t mixed_pixels() const { return state_ == State::kKnown ? mixed_pixels_ : 0; }

  // Returns how many of them lie in a part of the picture. Only if has_seen().
  std::int64_t mixed_within(const PixelRect& part) const;

  // Returns their share of these tiles. It is of what is known, or was until it was forgotten.
  double mixed_share() const {
    const auto side = static_cast<std::size_t>(tile_pixels());
    return tiles_seen_ > 0
               ? static_cast<double>(mixed_pixels_) / static_cast<double>(tiles_seen_ * side * side)
               : 0;
  }

  Fineness fineness() const { return {density_, share_lines_, share_points_, has_thin_}; }

  std::uint32_t surface_of(std::uint32_t primitive) const { return shapes_.surface_of(primitive); }

  int points_per_side() const { return density_; }
  int log2_points_per_side() const { return log2_density_; }

  // Whether what is seen is known: every primitive has a shape (image_shape.h), and they are not too many.
  // That one has no shape may show late: a primitive is projected when a tile that it may meet is asked for.
  bool is_known() { return state_ == State::kKnown || (state_ == State::kNotAsked && bound_all()); }

  // Whether it has been asked for and is known.
  bool has_seen() const { return state_ == State::kKnown; }

  // Returns the tile that holds a pixel. Only if is_known().
  const VisibleTile& tile(int pixel_x, int pixel_y) {
    const auto number = static_cast<std::size_t>((pixel_y >> log2_tile_pixels()) * columns_ +
                                                 (pixel_x >> log2_tile_pixels()));
    if (!is_seen_[number]) see(number);
    return *tiles_[number];
  }

  // Sees all tiles that meet a part of the picture, as tile() does, until it shows that one has no shape.
  // Only if is_known().
  void see_within(const PixelRect& part);

  // Returns the surface at an image point, pixels: of the primitives at the points around it the nearest
  // there. Only if is_known().
  std::uint32_t at(const Vec2d& point);

  // Returns the primitive in the middle of a pixel; 0: the background. Only if is_known().
  std::uint32_t primitive_in_middle(int pixel_x, int pixel_y) {
    const VisibleTile& seen = tile(pixel_x, pixel_y);
    const int half = density_ / 2, x = in_tile(pixel_x) * density_ + half,
              y = in_tile(pixel_y) * density_ + half;
    return seen.primitive(seen.row(y)[x]);
  }

  // Returns a primitive of a surface at one of the points around an image point, pixels; 0: none is. Only if
  // is_known().
  std::uint32_t primitive_at(const Vec2d& point, std::uint32_t surface);

  // Returns what is seen in a pixel, until the next call. Shares sum up to 1. Where all its points see one
  // surface that is all. Only if is_known().
  const SeenInPixel& seen_in(int pixel_x, int pixel_y);

  int tile_pixels() const { return kTileIntervals >> log2_density_; }

  // Returns a pixel's place in its tile.
  int in_tile(int pixel) const { return pixel & (tile_pixels() - 1); }

  // Returns the surface at a point of the picture, counted in intervals; 0: the background. Only if
  // is_known().
  std::uint32_t at(int x, int y) {
    const int column = std::min(x / kTileIntervals, columns_ - 1),
              row = std::min(y / kTileIntervals, rows_ - 1);
    const auto number = static_cast<std::size_t>(row * columns_ + column);
    if (!is_seen_[number]) see(number);
    return tiles_[number]->at(x - column * kTileIntervals, y - row * kTileIntervals);
  }

 private:
  static constexpr int kLog2Intervals = 6;
  static_assert(1 << kLog2Intervals == kTileIntervals);
  int log2_tile_pixels() const { return kLog2Intervals - log2_density_; }

  enum class State : std::uint8_t { kNotAsked, kKnown, kUnknown };

  bool has_shapes() const {
    constexpr std::uint32_t kMost = 1 << 20;
    return shapes_.project && shapes_.count > 0 && shapes_.count <= kMost;
  }

  // A quadric or a facet.
  struct Item {
    std::uint32_t primitive = 0;
    std::uint32_t shape = 0;  // its number among the quadrics or facets
    bool is_quadric = false;
    float nearest = 0;  // no point of it is nearer
    Vec2d origin{0, 0};
    ImageBounds bounds;
  };
  struct TileRange {
    int x0, y0, x1, y1;  // inclusive; empty: x1 < x0
  };

  // The points around an image point, as own numbers of its tile.
  struct PointsAround {
    const VisibleTile& tile;
    std::array<std::uint16_t, 4> numbers;
  };
  PointsAround points_around(const Vec2d& point);
  // Calls visit(quadric or facet, from its origin) for the parts of a primitive in a tile whose bounds meet a
  // rectangle.
  template <class Visit>
  void for_each_item(const VisibleTile& tile, std::uint16_t number, const ImageBounds& within,
                     const Visit& visit) const;
  TileRange tiles_that_meet(const ImageBounds& bounds) const;
  // The items of a primitive: numbers that follow each other.
  struct ItemRange {
    std::uint32_t begin = 0, end = 0;
    bool is_projected = false;
  };
  bool bound_all();
  void bound_by_projection(std::uint32_t primitive, ShapeBounds& bounds);
  const ItemRange& project(std::uint32_t primitive);
  void add(std::uint32_t primitive, const ImageShape& shape);
  void assign_to_tiles();
  void see(std::size_t tile);
  void list_items(std::size_t number, VisibleTile& tile);
  void compress(VisibleTile& tile);
  void count_points(const VisibleTile& tile);
  bool is_thin(const Item& item, std::uint32_t own, float x, float y) const;
  void list_thin(std::size_t number, VisibleTile& tile);
  void find_shares(int pixel_x, int pixel_y, SeenInPixel& seen);
  float share_out(bool are_rows, SeenInPixel& seen);
  void find_shapes(int pixel_x, int pixel_y, const SeenInPixel& seen);
  // What the points of a pixel see: how many primitives, and up to which nearness.
  struct SeenAtPoints {
    std::size_t count;
    float most_nearness;
  };
  void find_thin_shapes(int pixel_x, int pixel_y, const SeenAtPoints& at_points, bool is_before,
                        SeenInPixel& seen);
  void count_shares(std::span<float> shares) const;
  void find_surfaces(VisibleTile& tile);
  void count_mixed(const VisibleTile& tile);

  int right_, bottom_;
  int log2_density_ = 2;
  int density_ = 4;                          // points along a pixel's side
  int share_lines_ = 8, share_points_ = 64;  // Fineness
  bool has_thin_ = true;                     // the same
  int columns_ = 0, rows_ = 0;               // of tiles
  PrimitiveShapes shapes_;
  State state_ = State::kNotAsked;
  double most_rays_ = kNoLimit;
  SeeingPrice price_;
  std::size_t items_within_ = 0;
  std::size_t trials_ = 0, tiles_seen_ = 0;            // trials of items in tiles
  std::size_t mixed_pixels_ = 0;                       // of these tiles
  std::size_t quadric_blocks_ = 0, facet_blocks_ = 0;  // in which items were rasterised
  PixelRect within_;
  std::vector<ShapeBounds> bounds_;  // of each primitive
  std::vector<ItemRange> items_of_;  // of each primitive
  std::vector<Item> items_;
  std::vector<ProjectedQuadric> quadrics_;
  std::vector<ProjectedFacet> facets_;
  std::vector<std::uint32_t> first_of_tile_, of_tile_;  // primitives that may meet each tile
  std::vector<std::uint8_t> is_seen_;                   // per tile
  std::vector<std::unique_ptr<VisibleTile>> tiles_;     // null: never rasterised
  // Of the tile being rasterised. An item, and its primitive's number in the tile.
  struct Numbered {
    float nearest;
    std::uint32_t item;
    std::uint32_t number;
  };
  std::vector<Numbered> order_, not_hidden_;  // both the nearest first
  DepthBlocks blocks_;
  std::vector<float> nearest_;          // of the tile being rasterised
  std::vector<std::uint32_t> numbers_;  // the same
  std::vector<std::uint16_t> on_surface_;
  std::vector<std::uint16_t> first_of_surface_;  // in the tile, by surface
  struct BlockEntry {
    VisibleTile::InBlock item;
    std::uint8_t block;
  };
  std::vector<BlockEntry> entries_;
  std::vector<std::uint32_t> points_of_;  // by a tile's own number
  SeenInPixel seen_;                      // of the pixel asked for last
  std::vector<ShapeInPixel> in_pixel_;    // its shapes
  ImageShape asked_;
};

template <class Visit>
void VisibilityBuffer::for_each_item(const VisibleTile& tile, std::uint16_t number, const ImageBounds& within,
                                     const Visit& visit) const {
  const std::uint32_t primitive = tile.primitives_[number];
  if (primitive == 0) return;
  for (std::uint32_t i = tile.first_item_[number]; i < tile.items_.size(); ++i) {
    const Item& item = items_[tile.items_[i]];
    if (item.primitive != primitive) return;
    const ImageBounds& b = item.bounds;
    if (b.x0 > within.x1 || b.x1 < within.x0 || b.y0 > within.y1 || b.y1 < within.y0) continue;
    const Vec2f from(static_cast<float>(within.x0 - item.origin.x),
                     static_cast<float>(within.y0 - item.origin.y));
    if (item.is_quadric) {
      visit(quadrics_[item.shape], from);
    } else {
      visit(facets_[item.shape], from);
    }
  }
}

}  // namespace pprt
