#include "pipeline/visibility/visibility_buffer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {
namespace {

// Whether a box meets a rectangle of pixels.
bool meets(const ImageBounds& box, const PixelRect& pixels) {
  return box.x0 <= box.x1 && box.x1 >= static_cast<float>(pixels.x0) &&
         box.y1 >= static_cast<float>(pixels.y0) && box.x0 <= static_cast<float>(pixels.x1) &&
         box.y0 <= static_cast<float>(pixels.y1);
}

// Returns an upper bound of a facet's nearness.
float nearest_of(const ImageFacet& facet) {
  const ImageBounds& b = facet.bounds;
  if (b.x0 == kEverywhere.x0) return std::numeric_limits<float>::infinity();
  const LinearForm& n = facet.nearness;
  const double most =
      n.constant + std::max(n.per_x * b.x0, n.per_x * b.x1) + std::max(n.per_y * b.y0, n.per_y * b.y1);
  constexpr double kGrowth = 1 + 0x1p-16;
  return static_cast<float>(most * kGrowth);
}

}  // namespace

VisibilityBuffer::VisibilityBuffer(int right, int bottom, PrimitiveShapes shapes)
    : right_(right), bottom_(bottom), shapes_(std::move(shapes)) {
  forget(kFine);
  limit(kNoLimit);
}

void VisibilityBuffer::forget(const Fineness& fineness) {
  state_ = has_shapes() && most_rays_ > 0 ? State::kNotAsked : State::kUnknown;
  density_ = fineness.points_per_side, log2_density_ = std::countr_zero(static_cast<unsigned>(density_)),
  share_lines_ = fineness.share_lines, share_points_ = fineness.share_points;
  has_thin_ = fineness.has_thin;
  columns_ = (right_ + tile_pixels() - 1) / tile_pixels(),
  rows_ = (bottom_ + tile_pixels() - 1) / tile_pixels();
  is_seen_.assign(static_cast<std::size_t>(columns_ * rows_), 0);
}

// Finds the tiles that each primitive may meet. False where a primitive is known to have no shape, or where
// seeing them would take too long.
bool VisibilityBuffer::bound_all() {
  constexpr std::size_t kAtOnce = 1024;
  items_.clear(), quadrics_.clear(), facets_.clear();
  items_of_.assign(shapes_.count, {});
  std::fill(is_seen_.begin(), is_seen_.end(), std::uint8_t{0});  // tiles list items
  bounds_.resize(shapes_.count);
  state_ = State::kKnown;
  std::size_t& items = items_within_;
  items = 0, trials_ = tiles_seen_ = mixed_pixels_ = quadric_blocks_ = facet_blocks_ = 0;
  for (std::size_t first = 0; first < bounds_.size(); first += kAtOnce) {
    const std::span<ShapeBounds> now(bounds_.data() + first, std::min(kAtOnce, bounds_.size() - first));
    if (shapes_.bound) shapes_.bound(static_cast<std::uint32_t>(first), now);
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (!shapes_.bound || now[i].box.x0 == kEverywhere.x0)
        bound_by_projection(static_cast<std::uint32_t>(first + i + 1), now[i]);
      if (meets(now[i].box, within_)) items += now[i].parts;
    }
    const double so_far = static_cast<double>(first) / static_cast<double>(bounds_.size());
    if (so_far * bounding() + price_.of(items) > most_rays_) state_ = State::kUnknown;
    if (state_ == State::kUnknown) {
      items_.clear(), quadrics_.clear(), facets_.clear();
      return false;
    }
  }
  assign_to_tiles();
  if (tiles_.size() < is_seen_.size()) tiles_.resize(is_seen_.size());
  nearest_.resize(kTilePlaces);
  numbers_.resize(kTilePlaces);
  return true;
}

void VisibilityBuffer::bound_by_projection(std::uint32_t primitive, ShapeBounds& bounds) {
  bounds = {};
  const ItemRange& of = project(primitive);
  for (std::uint32_t i = of.begin; i < of.end; ++i) {
    bounds.box = bounds.parts++ == 0 ? items_[i].bounds : around(bounds.box, items_[i].bounds);
  }
}

// Projects a primitive when it is asked for first.
const VisibilityBuffer::ItemRange& VisibilityBuffer::project(std::uint32_t primitive) {
  ItemRange& of = items_of_[primitive - 1];
  if (of.is_projected) return of;
  of = {static_cast<std::uint32_t>(items_.size()), 0, true};
  shapes_.project(primitive, asked_);
  if (asked_.kind == ImageShape::Kind::kUnknown) {
    state_ = State::kUnknown;
  } else {
    add(primitive, asked_);
  }
  of.end = static_cast<std::uint32_t>(items_.size());
  return of;
}

void VisibilityBuffer::add(std::uint32_t primitive, const ImageShape& shape) {
  const auto origin_of = [this](const ImageBounds& b) {
    const auto middle = [](float low, float high, int most) {
      const double from = std::max(low, 0.0F), to = std::min(high, static_cast<float>(most));
      return 0.5 * (from + to);
    };
    return Vec2d(middle(b.x0, b.x1, right_), middle(b.y0, b.y1, bottom_));
  };
  const PixelRect picture = {0, 0, right_, bottom_};
  if (shape.kind == ImageShape::Kind::kQuadric) {
    const ImageBounds& box = shape.quadric.bounds;
    if (!meets(box, picture)) return;
    const Vec2d origin = origin_of(box);
    items_.push_back(
        {primitive, static_cast<std::uint32_t>(quadrics_.size()), true, shape.quadric.nearest, origin, box});
    quadrics_.emplace_back(shape.quadric, origin);
    return;
  }
  for (const ImageFacet& facet : shape.facets) {
    if (!meets(facet.bounds, picture)) continue;
    const Vec2d origin = origin_of(facet.bounds);
    items_.push_back({primitive, static_cast<std::uint32_t>(facets_.size()), false, nearest_of(facet), origin,
                      facet.bounds});
    facets_.emplace_back(facet, origin);
  }
}

VisibilityBuffer::TileRange VisibilityBuffer::tiles_that_meet(const ImageBounds& b) const {
  const auto side = static_cast<float>(tile_pixels());
  const auto tile = [side](float at, int count) {
    return static_cast<int>(std::clamp(at / side, 0.0F, static_cast<float>(count - 1)));
  };
  return {tile(b.x0 - 1, columns_), tile(b.y0 - 1, rows_), tile(b.x1 + 1, columns_), tile(b.y1 + 1, rows_)};
}

// By counting, so that each tile's primitives are in order: of two equally near ones the first is seen.
void VisibilityBuffer::assign_to_tiles() {
  const PixelRect picture = {0, 0, right_, bottom_};
  const auto for_each_tile = [&](const ShapeBounds& bounds, const auto& visit) {
    if (!meets(bounds.box, picture)) return;
    const TileRange tiles = tiles_that_meet(bounds.box);
    for (int y = tiles.y0; y <= tiles.y1; ++y)
      for (int x = tiles.x0; x <= tiles.x1; ++x) visit(static_cast<std::size_t>(y * columns_ + x));
  };
  first_of_tile_.assign(is_seen_.size() + 1, 0);
  for (const ShapeBounds& bounds : bounds_)
    for_each_tile(bounds, [this](std::size_t t) { ++first_of_tile_[t + 1]; });
  for (std::size_t t = 1; t < first_of_tile_.size(); ++t) first_of_tile_[t] += first_of_tile_[t - 1];
  of_tile_.resize(first_of_tile_.back());
  std::vector<std::uint32_t> next(first_of_tile_.begin(), first_of_tile_.end() - 1);
  for (std::size_t i = 0; i < bounds_.size(); ++i)
    for_each_tile(bounds_[i],
                  [&](std::size_t t) { of_tile_[next[t]++] = static_cast<std::uint32_t>(i + 1); });
}

// Lists the items that may meet a tile, and numbers their primitives.
void VisibilityBuffer::list_items(std::size_t number, VisibleTile& tile) {
  tile.primitives_.assign(1, 0);
  tile.items_.clear(), tile.first_item_.assign(1, 0);
  order_.clear();
  const auto column = static_cast<int>(number) % columns_, row = static_cast<int>(number) / columns_;
  for (std::uint32_t i = first_of_tile_[number]; i < first_of_tile_[number + 1]; ++i) {
    const std::uint32_t primitive = of_tile_[i];
    const ItemRange of = project(primitive);
    for (std::uint32_t item = of.begin; item < of.end; ++item) {
      const TileRange tiles = tiles_that_meet(items_[item].bounds);
      if (column < tiles.x0 || column > tiles.x1 || row < tiles.y0 || row > tiles.y1) continue;
      if (tile.primitives_.back() != primitive) {
        tile.primitives_.push_back(primitive);
        tile.first_item_.push_back(static_cast<std::uint32_t>(tile.items_.size()));
      }
      tile.items_.push_back(item);
      order_.push_back({items_[item].nearest, item, static_cast<std::uint32_t>(tile.primitives_.size() - 1)});
    }
  }
}

void VisibilityBuffer::see_within(const PixelRect& part) {
  for (int y = part.y0; y < part.y1; y += tile_pixels() - in_tile(y))
    for (int x = part.x0; x < part.x1 && has_seen(); x += tile_pixels() - in_tile(x)) tile(x, y);
}

void VisibilityBuffer::see(std::size_t number) {
  is_seen_[number] = 1;
  ++tiles_seen_;
  if (!tiles_[number]) tiles_[number] = std::make_unique_for_overwrite<VisibleTile>();
  VisibleTile& tile = *tiles_[number];
  list_items(number, tile);
  if (order_.empty()) {
    tile.points_.fill(0);
    tile.uniform_.fill(~0U);
    tile.surfaces_.assign(1, 0), tile.first_of_surface_.assign(1, 0);
    tile.in_blocks_.clear(), tile.first_in_block_.fill(0);
    return;
  }
  clear_points(nearest_.data(), numbers_.data());
  // The nearest first, for they hide others. The order changes nothing else: of equally near points that of
  // the first primitive is seen.
  std::sort(order_.begin(), order_.end(), [](const Numbered& a, const Numbered& b) {
    return a.nearest != b.nearest ? a.nearest > b.nearest : a.item < b.item;
  });
  const auto column = static_cast<int>(number) % columns_, row = static_cast<int>(number) / columns_;
  const int left = column * tile_pixels(), top = row * tile_pixels();
  const auto side = static_cast<float>(tile_pixels()), density = static_cast<float>(density_);
  const auto x = static_cast<float>(left), y = static_cast<float>(top);
  blocks_.clear();
  not_hidden_.clear();
  for (const auto& [nearest, number_of_item, own] : order_) {
    const Item& item = items_[number_of_item];
    const ImageBounds box = {item.bounds.x0 - x, item.bounds.y0 - y, std::min(item.bounds.x1 - x, side),
                             std::min(item.bounds.y1 - y, side)};
    const Vec2f corner(static_cast<float>(left - item.origin.x), static_cast<float>(top - item.origin.y));
    TileTarget to{1 / density, density, corner, box, nearest_.data(), numbers_.data(), {}};
    const PointSpan columns = to.columns(), rows = to.rows();
    if (columns.begin >= columns.end || rows.begin >= rows.end) {
      not_hidden_.push_back({nearest, number_of_item, own});
      continue;
    }
    if (!item.is_quadric && misses(facets_[item.shape], to)) continue;
    ++trials_;
    if (!blocks_.find_shown(columns, rows, nearest_.data(), nearest, to.blocks)) continue;
    not_hidden_.push_back({nearest, number_of_item, own});
    const BlockSet changed =
        item.is_quadric ? rasterise(quadrics_[item.shape], own, to) : rasterise(facets_[item.shape], own, to);
    blocks_.touch(changed);
    (item.is_quadric ? quadric_blocks_ : facet_blocks_) += count_of(changed);
  }
  compress(tile);
  find_surfaces(tile);
  count_mixed(tile);
  if (has_thin_) list_thin(number, tile);
}

void VisibilityBuffer::count_mixed(const VisibleTile& tile) {
  const auto side = static_cast<std::size_t>(tile_pixels());
  const std::uint32_t all = side < 32 ? (1U << side) - 1 : ~0U;
  for (std::size_t y = 0; y < side; ++y)
    mixed_pixels_ += static_cast<std::size_t>(std::popcount(~tile.uniform_[y] & all));
}

std::int64_t VisibilityBuffer::mixed_within(const PixelRect& part) const {
  const int side = tile_pixels();
  std::int64_t mixed = 0;
  for (int row = part.y0 / side; row < rows_ && row * side < part.y1; ++row) {
    for (int column = part.x0 / side; column < columns_ && column * side < part.x1; ++column) {
      const auto number = static_cast<std::size_t>(row * columns_ + column);
      if (is_seen_[number] == 0) continue;
      const int x0 = std::max(part.x0 - column * side, 0), x1 = std::min(part.x1 - column * side, side);
      const auto before = [](int x) { return x < 32 ? (1U << x) - 1 : ~0U; };
      const std::uint32_t inside = before(x1) & ~before(x0);
      const int y1 = std::min(part.y1 - row * side, side);
      for (int y = std::max(part.y0 - row * side, 0); y < y1; ++y)
        mixed += std::popcount(~tiles_[number]->uniform_[static_cast<std::size_t>(y)] & inside);
    }
  }
  return mixed;
}

// Counts the points that each primitive is seen at.
void VisibilityBuffer::count_points(const VisibleTile& tile) {
  points_of_.assign(tile.primitives_.size(), 0);
  for (int y = 0; y <= kTileIntervals; ++y) {
    const std::uint16_t* row = tile.row(y);
    for (int x = 0; x <= kTileIntervals; ++x) ++points_of_[row[x]];
  }
}

// Whether an item is so thin that it may pass between points. `x`, `y`: the tile's corner.
bool VisibilityBuffer::is_thin(const Item& item, std::uint32_t own, float x, float y) const {
  constexpr float kThin = 1.5F;  // points across it
  const auto side = static_cast<float>(tile_pixels());
  const ImageBounds& b = item.bounds;
  const float width = std::min(b.x1, x + side) - std::max(b.x0, x);
  const float height = std::min(b.y1, y + side) - std::max(b.y0, y);
  const float points_along = static_cast<float>(density_) * std::max(width, height);
  return static_cast<float>(points_of_[own]) <= kThin * points_along;
}

// Lists by block what is thin and may be seen there: by bounds, edges and nearness, in the order of nearness.
void VisibilityBuffer::list_thin(std::size_t number, VisibleTile& tile) {
  count_points(tile);
  constexpr auto kSide = static_cast<int>(VisibleTile::kBlocksOfPixels);
  const int pixels = kBlockSide / density_;  // along a block's side
  const DepthBlocks::OfBlocks& least_of = blocks_.least(nearest_.data());
  std::array<std::array<float, kSide>, kSide> least;  // of a block's points and those next to them
  std::array<std::uint32_t, kSide> mixed{};           // a bit for each block of a row
  for (std::size_t y = 0; y < kSide; ++y) {
    for (std::size_t x = 0; x < kSide; ++x) {
      const bool is_uniform =
          tile.is_uniform(pixels * static_cast<int>(x), pixels * static_cast<int>(y), pixels);
      mixed[y] |= (is_uniform ? 0U : 1U) << x;
      least[y][x] = std::min(std::min(least_of[y][x], least_of[y][x + 1]),
                             std::min(least_of[y + 1][x], least_of[y + 1][x + 1]));
    }
  }
  entries_.clear();
  const int left = static_cast<int>(number) % columns_ * tile_pixels();
  const int top = static_cast<int>(number) / columns_ * tile_pixels();
  const auto side = static_cast<float>(pixels);
  for (const auto& [nearest, number_of_item, own] : not_hidden_) {
    if (own == 0) continue;
    const Item& item = items_[number_of_item];
    if (!is_thin(item, own, static_cast<float>(left), static_cast<float>(top))) continue;
    const ImageBounds& box = item.bounds;
    const auto block_of = [&](float at, int begin) {
      return static_cast<int>(std::clamp((at - static_cast<float>(begin)) / side, 0.0F, kSide - 1.0F));
    };
    const int x0 = block_of(box.x0, left), x1 = block_of(box.x1, left), y1 = block_of(box.y1, top);
    for (int y = block_of(box.y0, top); y <= y1; ++y) {
      std::uint32_t blocks = mixed[static_cast<std::size_t>(y)] & ((2U << x1) - (1U << x0));
      for (; blocks != 0; blocks &= blocks - 1) {
        const int x = std::countr_zero(blocks);
        if (nearest < least[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)]) continue;
        const auto u = static_cast<float>(left + pixels * x - item.origin.x);
        const auto v = static_cast<float>(top + pixels * y - item.origin.y);
        if (!item.is_quadric && misses(facets_[item.shape], u, v, u + side, v + side)) continue;
        entries_.push_back(
            {{number_of_item, static_cast<std::uint16_t>(own)}, static_cast<std::uint8_t>(y * kSide + x)});
      }
    }
  }
  auto& first = tile.first_in_block_;
  first.fill(0);
  for (const BlockEntry& entry : entries_) ++first[entry.block + 1U];
  for (std::size_t block = 1; block < first.size(); ++block) first[block] += first[block - 1];
  tile.in_blocks_.resize(entries_.size());
  std::array<std::uint32_t, kSide * kSide> next;
  std::copy_n(first.begin(), next.size(), next.begin());
  for (const BlockEntry& entry : entries_) tile.in_blocks_[next[entry.block]++] = entry.item;
}

// Numbers each surface by the first of its primitives, and marks the pixels that see one only.
void VisibilityBuffer::find_surfaces(VisibleTile& tile) {
  tile.surfaces_.clear(), tile.first_of_surface_.clear();
  bool is_one_each = true;
  for (const std::uint32_t primitive : tile.primitives_) {
    const std::uint32_t surface = shapes_.surface_of(primitive);
    tile.first_of_surface_.push_back(static_cast<std::uint16_t>(tile.surfaces_.size()));
    tile.surfaces_.push_back(surface);
    is_one_each = is_one_each && surface == primitive;
  }
  if (is_one_each) {
    mark_uniform(tile.points_.data(), density_, tile.uniform_.data());
    return;
  }
  constexpr std::uint16_t kNone = 0xFFFF;
  if (first_of_surface_.empty()) first_of_surface_.assign(shapes_.surfaces.size(), kNone);
  for (std::uint16_t& number : tile.first_of_surface_) {
    std::uint16_t& first = first_of_surface_[tile.surfaces_[number]];
    if (first == kNone) first = number;
    number = first;
  }
  for (const std::uint32_t surface : tile.surfaces_) first_of_surface_[surface] = kNone;
  on_surface_.resize(tile.points_.size());
  const std::uint16_t* first = tile.first_of_surface_.data();
  std::transform(tile.points_.begin(), tile.points_.end(), on_surface_.begin(),
                 [first](std::uint16_t number) { return first[number]; });
  mark_uniform(on_surface_.data(), density_, tile.uniform_.data());
}

// Keeps the points as 16 bits. Gives new numbers to what is seen where a tile has more primitives:
// that is no more than there are points.
void VisibilityBuffer::compress(VisibleTile& tile) {
  constexpr std::size_t kMost = (std::size_t{1} << 16) - 1;
  if (tile.primitives_.size() > kMost) {
    std::vector<std::uint32_t> new_number(tile.primitives_.size(), 0);
    std::vector<std::uint32_t> seen(1, 0), first_item(1, 0);
    for (std::uint32_t& number : numbers_) {
      if (number != 0 && new_number[number] == 0) {
        new_number[number] = static_cast<std::uint32_t>(seen.size());
        seen.push_back(tile.primitives_[number]), first_item.push_back(tile.first_item_[number]);
      }
      number = new_number[number];
    }
    tile.primitives_ = std::move(seen), tile.first_item_ = std::move(first_item);
    for (Numbered& item : not_hidden_) item.number = new_number[item.number];
  }
  narrow(numbers_.data(), numbers_.size(), tile.points_.data());
}

VisibilityBuffer::PointsAround VisibilityBuffer::points_around(const Vec2d& point) {
  const int side = tile_pixels();
  const int column = std::min(static_cast<int>(point.x) / side, columns_ - 1);
  const int row = std::min(static_cast<int>(point.y) / side, rows_ - 1);
  const VisibleTile& seen = tile(column * side, row * side);
  const double x = (point.x - column * side) * density_, y = (point.y - row * side) * density_;
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = left < x ? left + 1 : left, bottom = top < y ? top + 1 : top;
  return {seen, {seen.row(top)[left], seen.row(top)[right], seen.row(bottom)[left], seen.row(bottom)[right]}};
}

std::uint32_t VisibilityBuffer::primitive_at(const Vec2d& point, std::uint32_t surface) {
  const auto& [seen, around] = points_around(point);
  for (const std::uint16_t number : around)
    if (seen.surfaces()[number] == surface) return seen.primitive(number);
  return 0;
}

std::uint32_t VisibilityBuffer::at(const Vec2d& point) {
  const auto& [seen, around] = points_around(point);
  if (around[0] == around[1] && around[0] == around[2] && around[0] == around[3])
    return seen.surfaces()[around[0]];
  const auto u = static_cast<float>(point.x), v = static_cast<float>(point.y);
  std::uint16_t nearest = 0;
  float most = 0;
  for (const std::uint16_t number : around) {
    for_each_item(seen, number, {u, v, u, v}, [&](const auto& shape, const Vec2f& from) {
      const float n = nearness(shape, from.x, from.y);
      if (n > most) most = n, nearest = number;
    });
  }
  return seen.surfaces()[nearest];
}

}  // namespace pprt
