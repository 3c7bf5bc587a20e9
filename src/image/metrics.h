// How far one picture is from another, and one sequence of pictures from another.
//
// Values are display values (docs/decisions/0004-display-values.md): what a screen is fed, 0 to 1, with no
// curve in between. Errors are measured on them as they are, beyond 1 too: unclamped differences are what a
// file holds. SSIM and FLIP are defined on the display range and clamp to it. To measure every figure on what
// a display shows, pass pictures through clamped_to_display first. FLIP alone models the eye, so it takes
// the values as sRGB-encoded and decodes them; nothing else does.
#pragma once

#include "image/image.h"

namespace pprt {

// An error is the difference `image - reference` of one channel's values, as they are (not clamped); a
// pixel's error is the largest magnitude of its three. A mean over the picture is over all channels of all
// pixels.
struct ImageDifference {
  double rmse = 0;                  // root of the mean squared error
  double psnr = 0;                  // dB for a peak of 1: -20 log10(rmse); infinite for equal pictures
  double ssim = 0;                  // see structural_similarity
  double max_error = 0;             // the largest pixel error
  double error_p999 = 0;            // 99.9 % of the pixels have at most this error (nearest rank)
  double share_over_threshold = 0;  // of the pixels: those whose error exceeds the threshold
  double signed_mean = 0;           // mean error: positive where the image is too bright
  double relative_mse = 0;          // mean of error^2 / (reference^2 + 0.01)
};

// Throws std::invalid_argument when the pictures differ in size, are empty, or hold values that are not
// finite.
ImageDifference difference(const Image& image, const Image& reference, double threshold);

// Mean structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004, equation 13) of the luma 0.2126 R +
// 0.7152 G + 0.0722 B, clamped to [0, 1]: 11x11 Gaussian windows of sigma 1.5, K1 = 0.01, K2 = 0.03, range 1.
// As in the authors' program only windows that lie in the picture count; along a side shorter than 11 pixels
// the window is as long as the side. 1 for equal pictures. Throws as `difference`.
double structural_similarity(const Image& a, const Image& b);

// The paper's viewing conditions: a screen 0.7 m wide of 3840 pixels, seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67;

// Mean over all pixels of FLIP (Andersson et al. 2020, for pictures of display range): the difference, 0 to
// 1, that one notices when the two are shown in turn, at so many pixels per degree of the field of view (1 to
// 1000). 0 for equal pictures; symmetric. Beyond the border pixels are as on it. Throws as `difference`, and
// std::invalid_argument for other pixels_per_degree.
double mean_flip(const Image& image, const Image& reference, double pixels_per_degree = kFlipPixelsPerDegree);

// Root mean square, over all channels of all pixels, of (now - before) - (reference_now - reference_before):
// the change from frame to frame that the reference has not. It is the rmse of the change of the error, so an
// error that stays the same does not flicker. Of a sequence: the root of the mean of its squares over all
// pairs of neighbouring frames. Throws as `difference`.
double flicker(const Image& before, const Image& now, const Image& reference_before,
               const Image& reference_now);

// Every value brought to the range [0, 1] of a display.
Image clamped_to_display(const Image& image);

// Picture of the pixels' differences, |image - reference| per channel, scaled so that the largest is 1; black
// for equal pictures. Throws as `difference`.
Image difference_picture(const Image& image, const Image& reference);

}  // namespace pprt
