// A plane of numbers, one per pixel, and separable filters over it. Private to src/image.
#pragma once

#include <vector>

namespace pprt {

// The value at (x, y) is values[y * width + x].
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;  // width * height, row by row
};

// Weights of neighbouring pixels, in the order of their coordinates. Any number of them, never none.
using Kernel = std::vector<double>;

// Samples exp(-x^2 / (2 sigma^2)) at `taps` places one pixel apart, centred at 0, and normalises their sum to
// 1.
Kernel gaussian(int taps, double sigma);

// Correlates the plane with the window across x down (the window is not mirrored). Only places where the
// whole window lies in the plane have a result, so each side shrinks by the window's length minus 1. The
// window must not be larger than the plane.
Plane filtered(const Plane& plane, const Kernel& across, const Kernel& down);

// Returns the plane extended by `margin` pixels on each side; they repeat the nearest pixel.
Plane with_margin(const Plane& plane, int margin);

}  // namespace pprt
