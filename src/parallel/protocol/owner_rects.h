// A partition as it travels: the regions of a new one are rectangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace pprt {

// Tiles of one owner. Its corner is the first tile, row by row, that no rectangle before has.
struct OwnerRect {
  std::int32_t owner = 0;
  std::uint16_t columns = 0, rows = 0;
};

// Returns rectangles for the owners of tiles, given row by row; one for each region that is a rectangle.
// Throws ProtocolError if the tiles do not make whole rows.
std::vector<OwnerRect> owner_rects(std::span<const std::int32_t> owners, std::int32_t columns);

// Returns the owners that the rectangles stand for. Throws ProtocolError unless they cover a grid of so many
// columns and rows, and no tile twice.
std::vector<std::int32_t> owners_by(std::span<const OwnerRect> rects, std::int32_t columns,
                                    std::int32_t rows);

}  // namespace pprt
