// Masks of dots and lines with soft edges.
#pragma once

#include <vector>

#include "base/vector.h"
#include "image/image.h"

namespace pprt {

// The covered share of each pixel, 0 to 1, row by row from the top. Where shapes overlap the larger share
// counts: a bundle of lines is no darker than one.
struct CoverageMask {
  int width;
  int height;
  std::vector<float> cover;

  CoverageMask(int w, int h)
      : width(w), height(h), cover(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0.0f) {}

  float at(int x, int y) const {
    return cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

// Draw a line with round ends, and a dot. Coordinates are image points: pixel (i, j) is the square
// [i, i+1] x [j, j+1]. The cover falls from 1 to 0 over one pixel of distance across the shape's edge. Parts
// outside the mask are left out.
void draw_line(CoverageMask& mask, const Vec2d& from, const Vec2d& to, double width);
void draw_dot(CoverageMask& mask, const Vec2d& center, double diameter);

// Mixes the colour into each pixel by its cover. Image and mask must have the same size.
void paint(Image& image, const CoverageMask& mask, const Color& color);

}  // namespace pprt
