// The parts of the difference evaluator FLIP for pictures of display range: P. Andersson, J. Nilsson,
// T. Akenine-Moeller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", Proc. ACM Comput. Graph. Interact. Tech. 3, 2, article 15 (2020). Written from the paper's
// formulas. Private to src/image, open for the tests; metrics.h has the
// whole.
//
//   display values -> opponent colours -> seen from afar -> L*a*b*, Hunt -> distance, 0..1 --+
//                          |                                                                 +-> difference
//                          +-> luminance -> edges and points -> difference of both, 0..1 ----+
#pragma once

#include <array>
#include <vector>

#include "base/vector.h"
#include "image/image.h"
#include "image/plane.h"

namespace pprt::flip {

// A colour of three numbers in double precision: linear RGB, XYZ relative to white, YyCxCz or L*a*b*.
using Triple = Vec3d;

// YyCxCz, a linear kind of L*a*b*: luminance, red-green and blue-yellow, a plane each.
using OpponentPlanes = std::array<Plane, 3>;
enum Channel { kLuminance, kRedGreen, kBlueYellow };

// The picture's values clamped to [0, 1] and decoded by the sRGB curve (IEC 61966-2-1), white point D65.
OpponentPlanes opponent_planes(const Image& image);

// The plane as the eye sees it: filtered by the channel's contrast sensitivity, beyond the
// border as on it.
Plane contrast_filtered(const Plane& plane, Channel channel, double pixels_per_degree);

// L*a*b* of an opponent colour, which is first brought into the range of sRGB, with a* and b* scaled by
// 0.01 L* (the Hunt effect: dark colours look less colourful).
Triple perceived(const Triple& opponent);

// |L1 - L2| + the Euclidean distance of (a, b).
double hyab(const Triple& a, const Triple& b);

// Maps hyab^0.7 to [0, 1]: what is up to 0.4 of green against blue to [0, 0.95], the rest to what is left
//.
double colour_error(double hyab_distance);

// Pixel by pixel, how much more edge or point there is in one luminance than in the other, in [0, 1]
//. Luminances are the kLuminance planes of opponent_planes.
std::vector<double> feature_errors(const Plane& a, const Plane& b, double pixels_per_degree);

// The error map: colour error ^ (1 - feature error), in [0, 1].
std::vector<double> error_map(const Image& image, const Image& reference, double pixels_per_degree);

}  // namespace pprt::flip
