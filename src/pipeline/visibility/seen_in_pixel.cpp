// What is seen in a pixel: at the points of the buffer first, then its shares.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/visibility/pixel_shares.h"
#include "pipeline/visibility/visibility_buffer.h"

namespace pprt {
namespace {

ShapeInPixel shape_in_pixel(const ProjectedQuadric& quadric, const Vec2f& from, std::size_t owner) {
  return {&quadric, nullptr, from.x, from.y, static_cast<std::uint32_t>(owner)};
}
ShapeInPixel shape_in_pixel(const ProjectedFacet& facet, const Vec2f& from, std::size_t owner) {
  return {nullptr, &facet, from.x, from.y, static_cast<std::uint32_t>(owner)};
}

// Whether a shape is known not to meet a pixel that its bounds meet. `from`: the pixel's corner.
bool misses_pixel(const ProjectedQuadric&, const Vec2f&) {
  return false;
}
bool misses_pixel(const ProjectedFacet& facet, const Vec2f& from) {
  return misses(facet, from.x, from.y, from.x + 1, from.y + 1);
}

constexpr float kLeft = 1.0F / 16;  // of a pixel: a part that is not accounted for

// The points of a pixel, row by row, its border included: weights, and weights times places, in three fields
// of a number. Points on the border count half, and a quarter in a corner.
constexpr int kField = 10;  // bits
template <int kDensity>
constexpr auto kPointWeights = [] {
  std::array<std::array<std::uint32_t, kDensity + 1>, kDensity + 1> weights{};
  for (std::uint32_t y = 0; y <= kDensity; ++y) {
    for (std::uint32_t x = 0; x <= kDensity; ++x) {
      const std::uint32_t weight = (x % kDensity == 0 ? 1 : 2) * (y % kDensity == 0 ? 1 : 2);
      weights[y][x] = weight | x * weight << kField | y * weight << 2 * kField;
    }
  }
  return weights;
}();

// Finds what the points of a pixel see. `row`: the point at the pixel's upper left corner.
template <int kDensity>
void find_at_points(const std::uint16_t* row, SeenInPixel& found) {
  static_assert(4 * kDensity * kDensity * kDensity < 1 << kField);
  std::array<std::uint32_t, SeenInPixel::kMost> sums;
  std::size_t count = 0, last = 0;
  for (const auto& weights : kPointWeights<kDensity>) {
    for (std::size_t x = 0; x < weights.size(); ++x) {
      if (count == 0 || found.numbers[last] != row[x]) {
        last = 0;
        while (last < count && found.numbers[last] != row[x]) ++last;
        static_assert((kDensity + 1) * (kDensity + 1) < SeenInPixel::kMost);
        if (last == count) found.numbers[count] = row[x], sums[count++] = 0;
      }
      sums[last] += weights[x];
    }
    row += kTileStride;
  }
  constexpr std::uint32_t kMask = (1U << kField) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto field = [&](int number) {
      return static_cast<float>(static_cast<std::int32_t>(sums[i] >> number * kField & kMask));
    };
    found.places[i] = Vec2f(field(1), field(2)) * (1 / (kDensity * field(0)));
  }
  found.count = count;
}

}  // namespace

const SeenInPixel& VisibilityBuffer::seen_in(int pixel_x, int pixel_y) {
  const VisibleTile& tile = this->tile(pixel_x, pixel_y);
  const int x = in_tile(pixel_x), y = in_tile(pixel_y);
  const std::uint16_t* corner = tile.row(y * density_) + x * density_;
  if (tile.is_uniform(x, y, 1)) {
    seen_.numbers[0] = corner[kTileStride * (density_ / 2) + density_ / 2];
    seen_.places[0] = Vec2f(0.5F, 0.5F), seen_.shares[0] = 1;
    seen_.count = 1;
    return seen_;
  }
  density_ == 2 ? find_at_points<2>(corner, seen_) : find_at_points<4>(corner, seen_);
  find_shares(pixel_x, pixel_y, seen_);
  return seen_;
}

// Lists the shapes of a pixel that are parts of what its points see.
void VisibilityBuffer::find_shapes(int pixel_x, int pixel_y, const SeenInPixel& seen) {
  const VisibleTile& tile = this->tile(pixel_x, pixel_y);
  const auto x = static_cast<float>(pixel_x), y = static_cast<float>(pixel_y);
  in_pixel_.clear();
  for (std::size_t i = 0; i < seen.count; ++i) {
    for_each_item(tile, seen.numbers[i], {x, y, x + 1, y + 1}, [&](const auto& shape, const Vec2f& from) {
      if (!misses_pixel(shape, from)) in_pixel_.push_back(shape_in_pixel(shape, from, i));
    });
  }
}

// Adds what is thin and passes between the points of a pixel: that before all they see, or the rest. Where it
// is more than can be listed, the last of the list stands for all that follow. The background keeps a place.
void VisibilityBuffer::find_thin_shapes(int pixel_x, int pixel_y, const SeenAtPoints& at_points,
                                        bool is_before, SeenInPixel& seen) {
  const VisibleTile& tile = this->tile(pixel_x, pixel_y);
  const auto x = static_cast<float>(pixel_x), y = static_cast<float>(pixel_y);
  const auto block_of = [this](int pixel) {
    return static_cast<std::size_t>(in_tile(pixel) * density_ / kBlockSide);
  };
  const std::size_t block = block_of(pixel_y) * VisibleTile::kBlocksOfPixels + block_of(pixel_x);
  for (std::size_t i = tile.first_in_block_[block]; i < tile.first_in_block_[block + 1]; ++i) {
    const auto& [item_number, number] = tile.in_blocks_[i];
    const Item& item = items_[item_number];
    if (is_before && item.nearest <= at_points.most_nearness) return;  // as is all that follows
    const ImageBounds& b = item.bounds;
    if (b.x0 > x + 1 || b.x1 < x || b.y0 > y + 1 || b.y1 < y) continue;
    const Vec2f from(static_cast<float>(x - item.origin.x), static_cast<float>(y - item.origin.y));
    if (!item.is_quadric && misses_pixel(facets_[item.shape], from)) continue;
    std::size_t owner = 0;
    while (owner < seen.count && seen.numbers[owner] != number) ++owner;
    if (owner < at_points.count) continue;
    owner = std::min(owner, SeenInPixel::kMost - 2);
    const ShapeInPixel shape = item.is_quadric ? shape_in_pixel(quadrics_[item.shape], from, owner)
                                               : shape_in_pixel(facets_[item.shape], from, owner);
    const float nearness = item.is_quadric ? item.nearest : depths_of(shape).least;
    if ((nearness > at_points.most_nearness) != is_before) continue;
    if (owner == seen.count) {
      seen.numbers[owner] = number, seen.places[owner] = Vec2f(0.5F, 0.5F);
      ++seen.count;
    }
    in_pixel_.push_back(shape);
  }
}

// Finds the shares of the shapes in a pixel. Returns their sum; the rest shows none of them.
float VisibilityBuffer::share_out(bool are_rows, SeenInPixel& seen) {
  const std::span<float> shares(seen.shares.data(), seen.count);
  std::fill(shares.begin(), shares.end(), 0.0F);
  if (!shares_on_lines(in_pixel_, are_rows, share_lines_, shares)) count_shares(shares);
  float all = 0;
  for (const float share : shares) all += share;
  return all;
}

void VisibilityBuffer::find_shares(int pixel_x, int pixel_y, SeenInPixel& seen) {
  const Vec2f apart = seen.places[0] - seen.places[1];
  const bool are_rows = std::fabs(apart.x) >= std::fabs(apart.y);
  find_shapes(pixel_x, pixel_y, seen);
  SeenAtPoints at_points{seen.count, 0};
  if (has_thin_) {
    for (const ShapeInPixel& shape : in_pixel_)
      at_points.most_nearness = std::max(at_points.most_nearness, depths_of(shape).most);
    find_thin_shapes(pixel_x, pixel_y, at_points, true, seen);
  }
  float all = share_out(are_rows, seen);
  if (has_thin_ && all < 1 - kLeft) {
    const std::size_t shapes = in_pixel_.size();
    find_thin_shapes(pixel_x, pixel_y, at_points, false, seen);
    if (in_pixel_.size() > shapes) all = share_out(are_rows, seen);
  }
  // What is left shows the background.
  const auto end = seen.numbers.begin() + static_cast<std::ptrdiff_t>(seen.count);
  const auto background = std::find(seen.numbers.begin(), end, std::uint16_t{0});
  if (background != end && all < 1) {
    seen.shares[static_cast<std::size_t>(background - seen.numbers.begin())] += 1 - all;
    return;
  }
  if (has_thin_ && all < 1 - kLeft) {
    seen.numbers[seen.count] = 0, seen.places[seen.count] = Vec2f(0.5F, 0.5F);
    seen.shares[seen.count++] = 1 - all;
    return;
  }
  for (std::size_t i = 0; i < seen.count; ++i)
    seen.shares[i] = all > 0 ? seen.shares[i] * (1 / all) : 1 / static_cast<float>(seen.count);
}

// The same by points.
void VisibilityBuffer::count_shares(std::span<float> shares) const {
  NearestInPixel nearest(share_points_);
  for (const ShapeInPixel& shape : in_pixel_) {
    const auto number = static_cast<std::int32_t>(shape.owner) + 1;
    if (shape.quadric != nullptr) {
      nearest.show(*shape.quadric, shape.left, shape.top, number);
    } else {
      nearest.show(*shape.facet, shape.left, shape.top, number);
    }
  }
  std::array<int, SeenInPixel::kMost + 1> counts;
  nearest.count({counts.data(), shares.size() + 1});
  for (std::size_t i = 0; i < shares.size(); ++i)
    shares[i] = static_cast<float>(counts[i + 1]) / static_cast<float>(share_points_);
}

}  // namespace pprt
