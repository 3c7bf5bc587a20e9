// Dots and lines with soft edges.
#pragma once

#include <vector>

#include "base/vector.h"
#include "image/image.h"

namespace pprt {

// How much of each pixel is covered, 0 to 1, row after row. Where shapes overlap, the greater cover counts: a
// bundle of lines is no darker than one.
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

// Coordinates as for image points: pixel (i, j) is the square [i, i+1] x [j, j+1]. A pixel's cover falls from
// 1 to 0 over the one pixel of distance about the shape's edge. What lies outside is left out.
void draw_line(CoverageMask& coverage, const Vec2d& from, const Vec2d& to, double width);  // with round ends
void draw_dot(CoverageMask& coverage, const Vec2d& center, double diameter);

// Lays the colour on where there is coverage; both of the same size.
void paint(Image& image, const CoverageMask& coverage, const Color& color);

}  // namespace pprt
