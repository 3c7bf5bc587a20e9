// The steps of the image metric FLIP for pictures of display range. Private to src/image, open for the tests;
// metrics.h has the whole.
//
// Source: P. Andersson, J. Nilsson, T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3, 2, article 15
// (2020). Written from the paper's formulas.
//
//   display values -> opponent colours -> contrast filter -> L*a*b*, Hunt -> HyAB distance --+
//                          |                                                                 +-> difference
//                          +-> luminance -> edges and points -> feature difference ----------+
#pragma once

#include <array>
#include <vector>

#include "base/vector.h"
#include "image/image.h"
#include "image/plane.h"

namespace pprt::flip {

// A colour in one of the spaces used here: linear RGB, XYZ relative to white, YyCxCz or L*a*b*.
using ColorVector = Vec3d;

// One plane each of luminance, red-green and blue-yellow: YyCxCz, a linear variant of L*a*b*.
using OpponentPlanes = std::array<Plane, 3>;
enum Channel { kLuminance, kRedGreen, kBlueYellow };

// Converts a picture to opponent colours. Its values are clamped to [0, 1] and decoded by the sRGB curve (IEC
// 61966-2-1, white point D65).
OpponentPlanes opponent_planes(const Image& image);

// Filters a plane by the channel's contrast sensitivity function. Outside the picture the border pixels
// repeat. The size stays the same.
Plane contrast_filtered(const Plane& plane, Channel channel, double pixels_per_degree);

// Converts an opponent colour, clamped to the sRGB gamut, to L*a*b*. Scales a* and b* by 0.01 L* (Hunt
// effect: dark colours look less colourful).
ColorVector perceived(const ColorVector& opponent);

// Returns the HyAB distance: |L1 - L2| + the Euclidean distance of (a, b).
double hyab(const ColorVector& a, const ColorVector& b);

// Maps hyab^0.7 to [0, 1] in two linear parts. Let m be its value for green against blue: [0, 0.4 m] goes to
// [0, 0.95], and [0.4 m, m] to [0.95, 1].
double colour_error(double hyab_distance);

// Returns per pixel, in [0, 1], by how much edges and points differ between two luminances. `a` and `b` are
// the kLuminance planes of opponent_planes.
std::vector<double> feature_errors(const Plane& a, const Plane& b, double pixels_per_degree);

// Feature strengths per pixel in a luminance from 0 (black) to 1 (white).
struct Features {
  std::vector<double> edges;
  std::vector<double> points;
};

// What FLIP makes of one picture, whichever it is compared with.
struct Seen {
  std::vector<ColorVector> colours;  // perceived
  Features features;
};

// Returns what a viewer sees of a picture at this distance.
Seen seen(const Image& image, double pixels_per_degree);

// Returns the error map: per pixel colour_error ^ (1 - feature_error), in [0, 1]. Both pictures have the same
// size and the same viewing distance.
std::vector<double> error_map(const Seen& image, const Seen& reference);
std::vector<double> error_map(const Image& image, const Image& reference, double pixels_per_degree);

}  // namespace pprt::flip
