#include "parallel/protocol/owner_rects.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "parallel/network/communicator.h"

namespace pprt {
namespace {

// No image has more: it has 2^14 x 2^14 pixels at most. Tiles have 32 pixels a side, or are some hundred for
// each of at most 4096 ranks. A few bytes must not announce more memory than that.
constexpr std::uint64_t kMostTiles = std::uint64_t{1} << 22;

constexpr std::int32_t kNobody = -1;

// A grid that is covered by rectangles, one after the other.
class Cover {
 public:
  Cover(std::size_t columns, std::size_t rows)
      : columns_(columns), rows_(rows), owners_(columns * rows, kNobody) {}

  // The first tile without an owner; the number of tiles if all have one.
  std::size_t first() const { return first_; }
  bool is_whole() const { return first_ == owners_.size(); }

  // Puts a rectangle on the first tile. Returns false, and changes nothing, where it does not fit into the
  // grid or covers a tile that has an owner.
  bool put(const OwnerRect& rect) {
    if (is_whole() || rect.columns == 0 || rect.rows == 0 || first_ % columns_ + rect.columns > columns_ ||
        first_ / columns_ + rect.rows > rows_)
      return false;
    for (std::size_t y = 0; y < rect.rows; ++y) {
      if (std::any_of(row(y), row(y) + rect.columns, [](std::int32_t owner) { return owner != kNobody; }))
        return false;
    }
    for (std::size_t y = 0; y < rect.rows; ++y) std::fill_n(row(y), rect.columns, rect.owner);
    while (!is_whole() && owners_[first_] != kNobody) ++first_;
    return true;
  }

  // How many tiles in a row from the first one on, so many rows below it, are free and the first one's
  // owner's by the list.
  std::size_t run(std::size_t rows_below, std::span<const std::int32_t> owners) const {
    const std::size_t begin = first_ + rows_below * columns_, end = (begin / columns_ + 1) * columns_;
    std::size_t tile = begin;
    while (tile < end && tile < owners.size() && owners_[tile] == kNobody && owners[tile] == owners[first_])
      ++tile;
    return tile - begin;
  }

  std::vector<std::int32_t> take_owners() { return std::move(owners_); }

 private:
  std::vector<std::int32_t>::iterator row(std::size_t below_first) {
    return owners_.begin() + static_cast<std::ptrdiff_t>(first_ + below_first * columns_);
  }

  std::size_t columns_, rows_;
  std::vector<std::int32_t> owners_;
  std::size_t first_ = 0;
};

}  // namespace

std::vector<OwnerRect> owner_rects(std::span<const std::int32_t> owners, std::int32_t columns) {
  const auto width = static_cast<std::size_t>(std::max(columns, 0));
  if (width > 0 ? owners.size() % width != 0 : !owners.empty())
    throw ProtocolError("the owners of tiles do not make whole rows");
  std::vector<OwnerRect> rects;
  for (Cover cover(width, width > 0 ? owners.size() / width : 0); !cover.is_whole();) {
    const std::size_t wide = cover.run(0, owners);
    std::size_t high = 1;
    while (cover.first() + high * width < owners.size() && cover.run(high, owners) >= wide) ++high;
    rects.push_back(
        {owners[cover.first()], static_cast<std::uint16_t>(wide), static_cast<std::uint16_t>(high)});
    cover.put(rects.back());
  }
  return rects;
}

std::vector<std::int32_t> owners_by(std::span<const OwnerRect> rects, std::int32_t columns,
                                    std::int32_t rows) {
  if (columns < 0 || rows < 0 ||
      static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) > kMostTiles)
    throw ProtocolError("a message announces tiles that cannot be");
  Cover cover(static_cast<std::size_t>(columns), static_cast<std::size_t>(rows));
  for (const OwnerRect& rect : rects) {
    if (rect.owner < 0 || !cover.put(rect)) throw ProtocolError("a message gives tiles that are not free");
  }
  if (!cover.is_whole()) throw ProtocolError("a message gives some tiles to nobody");
  return cover.take_owners();
}

}  // namespace pprt
