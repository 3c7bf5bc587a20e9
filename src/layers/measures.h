// What can be measured of a frame's samples, one value a pixel, row after row from the top.
#pragma once

#include <vector>

#include "layers/triangulation.h"

namespace pprt {

// Samples in each pixel; those on the lower and right border of the image count for the last one.
std::vector<float> sample_counts(const Triangulation& frame);

// Frames since the samples around were traced, interpolated. `frame_number`: the present one.
std::vector<float> ages(const Triangulation& frame, int frame_number);

// Samples per square pixel, smooth: at a sample the reciprocal of a third of its triangles' area, which is
// its share of the image, and linear in between.
std::vector<float> densities(const Triangulation& frame);

// Rays in the trees of the samples around, interpolated (paper fig. 1b).
std::vector<float> costs(const Triangulation& frame);

// The refinement weight of the triangle that holds the pixel's centre: the smaller, the more can the pixel be
// trusted; infinite where no triangle is.
std::vector<float> weights(const Triangulation& frame);

}  // namespace pprt
