// Error metrics of a picture, or of a sequence, against a reference.
//
// Values are display values (docs/decisions/0004-display-values.md): what a screen is fed, 0 to 1, without a
// transfer curve. Errors are differences of these values, not clamped. SSIM and FLIP are defined on the
// display range and clamp to it. To measure every metric on what a display shows, pass pictures through
// clamped_to_display first. Only FLIP decodes the values as sRGB, because it models the eye.
#pragma once

#include <memory>
#include <vector>

#include "image/image.h"

namespace pprt {

namespace flip {
struct Seen;
}

// Metrics of one picture. An error is the difference `image - reference` of one channel. A pixel's error is
// the largest magnitude of its three. A mean is over all channels of all pixels.
struct ImageDifference {
  double rmse = 0;                  // root of the mean squared error
  double psnr = 0;                  // dB for a peak of 1: -20 log10(rmse); infinite for equal pictures
  double ssim = 0;                  // see structural_similarity
  double max_error = 0;             // largest pixel error
  double error_p999 = 0;            // 99.9 % of the pixels have at most this error (nearest rank)
  double share_over_threshold = 0;  // share of the pixels whose error exceeds the threshold
  double signed_mean = 0;           // mean error: positive when the image is too bright
  double relative_mse = 0;          // mean of error^2 / (reference^2 + 0.01)
};

// Compares two pictures. Throws std::invalid_argument when they differ in size, are empty, or hold values
// that are not finite.
ImageDifference difference(const Image& image, const Image& reference, double threshold);

// Returns the mean structural similarity of the luma; 1 for equal pictures. Throws as `difference`.
//
// Source: Wang, Bovik, Sheikh and Simoncelli 2004, equation 13. Luma is 0.2126 R + 0.7152 G + 0.0722 B,
// clamped to [0, 1]. Windows are 11x11 Gaussians of sigma 1.5, with K1 = 0.01, K2 = 0.03, range 1. As in the
// authors' program, only windows inside the picture count. Along a side shorter than 11 pixels the window is
// as long as the side.
double structural_similarity(const Image& a, const Image& b);

// Pixels per degree of the paper's viewing conditions: a screen 0.7 m wide of 3840 pixels, seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67;

// Returns the mean of FLIP (Andersson et al. 2020, for pictures of display range) over all pixels. It is the
// difference, 0 to 1, that a viewer notices when the pictures are shown in turn. Symmetric; 0 for equal
// pictures. Outside the picture the border pixels repeat.
//
// `pixels_per_degree` of the field of view: 1 to 1000. Throws as `difference`, and std::invalid_argument for
// other pixels_per_degree.
double mean_flip(const Image& image, const Image& reference, double pixels_per_degree = kFlipPixelsPerDegree);

// Compares many pictures with one reference by mean_flip. Keeps what FLIP makes of the reference, half of the
// work. Results are equal, and errors thrown the same. Copies share what is kept; any number of threads may
// call `mean`.
class FlipReference {
 public:
  explicit FlipReference(const Image& reference, double pixels_per_degree = kFlipPixelsPerDegree);
  double mean(const Image& image) const;

  // Returns FLIP of each pixel, row by row.
  std::vector<double> map(const Image& image) const;

 private:
  int width_, height_;
  double pixels_per_degree_;
  std::shared_ptr<const flip::Seen> seen_;
};

// Returns the RMS, over all channels of all pixels, of (now - before) - (reference_now - reference_before).
// It is the RMSE of the change of the error: an error that stays the same does not flicker. For a sequence,
// take the root of the mean of its squares over all pairs of neighbouring frames. Throws as `difference`.
double flicker(const Image& before, const Image& now, const Image& reference_before,
               const Image& reference_now);

// Clamps every value to the display range [0, 1].
Image clamped_to_display(const Image& image);

// Returns |image - reference| per channel, scaled so that the largest value is 1; black for equal pictures.
// Throws as `difference`.
Image difference_picture(const Image& image, const Image& reference);

}  // namespace pprt
