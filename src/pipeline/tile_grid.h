// The image cut into equal square tiles: the unit of ownership and of statistics (paper s. 3.3).
#pragma once

#include <algorithm>
#include <cstddef>

namespace pprt {

// Half-open rectangle of pixels.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  std::size_t area() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }

  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

// Tiles are numbered row by row from the top left; those of the last column and row may be narrower.
struct TileGrid {
  int width = 1;  // image, pixels
  int height = 1;
  int tile_size = 16;  // pixels

  int columns() const { return (width + tile_size - 1) / tile_size; }
  int rows() const { return (height + tile_size - 1) / tile_size; }
  int tile_count() const { return columns() * rows(); }

  // The tile that holds an image point; points on the right and lower border belong to the last tile.
  int tile_at(double x, double y) const {
    const int column = std::clamp(static_cast<int>(x) / tile_size, 0, columns() - 1);
    const int row = std::clamp(static_cast<int>(y) / tile_size, 0, rows() - 1);
    return row * columns() + column;
  }

  PixelRect pixels(int tile) const {
    const int x0 = tile % columns() * tile_size;
    const int y0 = tile / columns() * tile_size;
    return {x0, y0, std::min(x0 + tile_size, width), std::min(y0 + tile_size, height)};
  }

  friend bool operator==(const TileGrid&, const TileGrid&) = default;
};

}  // namespace pprt
