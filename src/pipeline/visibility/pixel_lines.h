// How much of a pixel each shape is seen in, by lines across it. Private to the pipeline.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/silhouettes/projected_shape_cache.h"

namespace pprt {

// A part of a primitive that may be seen in a pixel: a quadric or a facet.
struct ShapeInPixel {
  const ProjectedQuadric* quadric;  // null: a facet
  const ProjectedFacet* facet;
  float left, top;      // the pixel's corner, from the shape's origin, pixels
  std::uint32_t owner;  // the primitive, by a number of its own
};

// Bounds a shape's nearness in a pixel; a quadric's by 0 and infinity.
struct Depths {
  float least, most;
};
Depths depths_of(const ShapeInPixel& shape);

// Adds to `shares` the part of a pixel in which each owner is seen: the mean over `count` lines, a multiple
// of eight. On each line it is exact where shapes end and where facets pass through each other. So is the
// share of a straight edge that crosses all lines. `are_rows`: the lines lie along x, otherwise along y.
// Returns false and leaves `shares` where lines cannot tell. They cannot of more than 16 shapes on the lines,
// nor of one that more than three owners hide. Nor can they where shapes of one owner lie before each other,
// or where a cone is seen in parts of its outline.
bool shares_on_lines(std::span<const ShapeInPixel> shapes, bool are_rows, int count, std::span<float> shares);

}  // namespace pprt
