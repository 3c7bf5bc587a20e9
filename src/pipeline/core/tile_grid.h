// The grid of equal square tiles over the image: the units of ownership and of statistics (paper s. 3.3).
#pragma once

#include <algorithm>
#include <cstddef>

namespace pprt {

// Half-open range of pixels along one axis.
struct PixelSpan {
  int begin = 0, end = 0;
};

// Half-open rectangle of pixels.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  std::size_t area() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }

  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

// Tiles are numbered row by row from the top left; those of the last column and row may be narrower.
class TileGrid {
 public:
  // The image's size and a tile's side, pixels, all positive.
  TileGrid(int image_width, int image_height, int tile_side)
      : width(image_width),
        height(image_height),
        tile_size(tile_side),
        columns_((width + tile_size - 1) / tile_size),
        rows_((height + tile_size - 1) / tile_size),
        tiles_per_pixel_(1.0 / tile_size) {}

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int tile_count() const { return columns_ * rows_; }

  // Returns the tile that holds an image point. Points on the right and lower border belong to the last tile.
  int tile_at(double x, double y) const { return column_at(x) + columns_ * row_at(y); }
  int column_at(double x) const { return lane(x, columns_); }
  int row_at(double y) const { return lane(y, rows_); }

  // Return the pixels of a column or a row of tiles.
  PixelSpan column(int column) const {
    return {column * tile_size, std::min((column + 1) * tile_size, width)};
  }
  PixelSpan row(int row) const { return {row * tile_size, std::min((row + 1) * tile_size, height)}; }

  PixelRect pixels(int tile) const {
    const PixelSpan x = column(tile % columns_), y = row(tile / columns_);
    return {x.begin, y.begin, x.end, y.end};
  }

  friend bool operator==(const TileGrid&, const TileGrid&) = default;

  int width;
  int height;
  int tile_size;

 private:
  // Returns the column or row of a coordinate, which may lie far outside the image. Multiplies the middle of
  // its pixel, so that rounding never reaches the next tile. A division would cost more than the rest of a
  // triangle's bookkeeping.
  int lane(double coordinate, int count) const {
    const double inside = std::clamp(coordinate, 0.0, static_cast<double>(count) * tile_size - 1);
    return static_cast<int>((static_cast<int>(inside) + 0.5) * tiles_per_pixel_);
  }

  int columns_;
  int rows_;
  double tiles_per_pixel_;
};

}  // namespace pprt
