// pprt-compare: how far one picture is from another, and whether that is too far.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

namespace pprt {

struct CompareOptions {
  std::string image;
  std::string reference;
  double threshold = 0.01;         // pixel errors above it count for the share; 2.55 of 255 levels
  std::optional<double> max_rmse;  // limits: what is not given is not checked
  std::optional<double> min_psnr;  // dB
  std::optional<double> min_ssim;
  std::optional<double> max_error;
  std::optional<double> max_share;  // 0 to 1
  std::string difference_picture;   // file to write; empty: none
  bool json = false;
};

// Prints the figures to `out`, and a line to `complaints` for every limit that is passed. True: within all
// limits. Throws UsageError (options that make no sense) and std::runtime_error (a file that cannot be read
// or written, pictures that cannot be compared).
bool compare(const CompareOptions& options, std::ostream& out, std::ostream& complaints);

}  // namespace pprt
