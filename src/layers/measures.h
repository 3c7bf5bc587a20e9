// Measures of a frame's samples: one value per pixel, row by row from the top.
#pragma once

#include <vector>

#include "layers/triangulation.h"

namespace pprt {

// Returns the number of samples in each pixel. Those on the lower and right border of the image count in the
// last pixel.
std::vector<float> sample_counts(const Triangulation& frame);

// Returns the age of the samples, interpolated, in frames before number `frame_number`.
std::vector<float> ages(const Triangulation& frame, int frame_number);

// Returns the samples per square pixel. At a sample that is the reciprocal of its share of the image, a third
// of its triangles' area; in between it is interpolated.
std::vector<float> densities(const Triangulation& frame);

// Returns the number of rays in a sample's ray tree, interpolated (paper fig. 1b).
std::vector<float> costs(const Triangulation& frame);

// Returns the refinement weight of the triangle that holds the pixel's centre; infinite where none does. A
// pixel of small weight can be trusted more.
std::vector<float> weights(const Triangulation& frame);

}  // namespace pprt
