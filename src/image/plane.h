// One number per pixel, and separable filters over it. Private to src/image.
#pragma once

#include <vector>

namespace pprt {

struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;  // width * height, row after row
};

// Weights of an odd or even number of neighbouring pixels, in the order of their coordinates; never empty.
using Kernel = std::vector<double>;

// Samples of exp(-x^2 / (2 sigma^2)) at `taps` places one pixel apart, 0 in their middle; their sum is 1.
Kernel gaussian(int taps, double sigma);

// The weighted sums at every place where the window of across.size() x down.size() pixels lies in the plane
// (correlation: the window is not mirrored). The result is smaller by the window's sides less one. The window
// must fit.
Plane filtered(const Plane& plane, const Kernel& across, const Kernel& down);

// The plane with `margin` more pixels on each side, each like the nearest one of the plane's own.
Plane with_margin(const Plane& plane, int margin);

}  // namespace pprt
