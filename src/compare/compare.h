// pprt-compare: the difference of two pictures or sequences, and whether it is within limits.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "cli/options/number_pair.h"
#include "image/metrics.h"

namespace pprt {

struct CompareOptions {
  std::string image;                 // a file, or a pattern of numbered files (image/frame_pattern.h)
  std::string reference;             // of the same kind
  std::optional<FrameRange> frames;  // of sequences; empty: all that are there
  double threshold = 0.01;           // pixel errors above it count for the share; 2.55 of 255 levels
  double pixels_per_degree = kFlipPixelsPerDegree;
  bool clamp = false;              // measure on values clamped to the display range
  std::optional<double> max_rmse;  // limits; empty: not checked
  std::optional<double> min_psnr;  // dB
  std::optional<double> max_relative_mse;
  std::optional<double> min_ssim;
  std::optional<double> max_flip;
  std::optional<double> max_error;
  std::optional<double> max_p999;
  std::optional<double> max_share;  // 0 to 1
  std::optional<double> max_flicker;
  std::string difference_picture;  // file or pattern to write; empty: none
  bool json = false;
};

// Prints the figures to `out`, and a line to `complaints` for every limit that is exceeded; for a sequence
// its worst frame counts. Returns whether all limits hold. Throws UsageError for options that make no sense,
// and std::runtime_error for files that cannot be read or written or pictures that cannot be compared.
bool compare(const CompareOptions& options, std::ostream& out, std::ostream& complaints);

}  // namespace pprt
