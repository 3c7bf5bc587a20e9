#include "image/metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "image/flip.h"
#include "image/plane.h"

namespace pprt {
namespace {

constexpr double kRelativeFloor = 0.01;  // keeps dark pixels from dominating the relative error

void require_same_size(int width, int height, int other_width, int other_height) {
  if (width != other_width || height != other_height) {
    throw std::invalid_argument("pictures of different sizes cannot be compared");
  }
}

void require_measurable(const Image& image) {
  if (image.pixels.empty()) throw std::invalid_argument("empty pictures cannot be compared");
  const auto finite = [](const Color& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
  };
  if (!std::all_of(image.pixels.begin(), image.pixels.end(), finite)) {
    throw std::invalid_argument("pictures with values that are not finite cannot be compared");
  }
}

void require_comparable(const Image& a, const Image& b) {
  require_same_size(a.width, a.height, b.width, b.height);
  require_measurable(a);
  require_measurable(b);
}

Plane luma(const Image& image) {
  Plane plane{image.width, image.height, {}};
  plane.values.reserve(image.pixels.size());
  for (const Color& c : image.pixels) {
    plane.values.push_back(std::clamp(0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z, 0.0, 1.0));
  }
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result = a;
  for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] *= b.values[i];
  return result;
}

// Returns the weighted means over all windows inside the plane.
std::vector<double> window_means(const Plane& plane) {
  constexpr int kSide = 11;
  constexpr double kSigma = 1.5;
  return filtered(plane, gaussian(std::min(kSide, plane.width), kSigma),
                  gaussian(std::min(kSide, plane.height), kSigma))
      .values;
}

double pixel_error(const Color& a, const Color& b) {
  double error = 0;
  for (int c = 0; c < 3; ++c) error = std::max(error, std::abs(double{a[c]} - double{b[c]}));
  return error;
}

}  // namespace

ImageDifference difference(const Image& image, const Image& reference, double threshold) {
  require_comparable(image, reference);
  double sum = 0;
  double squares = 0;
  double relative_squares = 0;
  std::vector<double> pixel_errors;
  pixel_errors.reserve(image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Color& a = image.pixels[i];
    const Color& b = reference.pixels[i];
    for (int c = 0; c < 3; ++c) {
      const double error = double{a[c]} - double{b[c]};
      sum += error;
      squares += error * error;
      relative_squares += error * error / (double{b[c]} * b[c] + kRelativeFloor);
    }
    pixel_errors.push_back(pixel_error(a, b));
  }

  ImageDifference result;
  const auto pixels = static_cast<double>(image.pixels.size());
  result.rmse = std::sqrt(squares / (3 * pixels));
  result.psnr = -20 * std::log10(result.rmse);
  result.ssim = structural_similarity(image, reference);
  result.signed_mean = sum / (3 * pixels);
  result.relative_mse = relative_squares / (3 * pixels);
  const auto over =
      std::count_if(pixel_errors.begin(), pixel_errors.end(), [&](double e) { return e > threshold; });
  result.share_over_threshold = static_cast<double>(over) / pixels;

  const std::size_t rank = (pixel_errors.size() * 999 + 999) / 1000;  // nearest rank, from 1
  const auto at_rank = pixel_errors.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(pixel_errors.begin(), at_rank, pixel_errors.end());
  result.error_p999 = *at_rank;
  result.max_error = *std::max_element(at_rank, pixel_errors.end());
  return result;
}

double structural_similarity(const Image& a, const Image& b) {
  require_comparable(a, b);
  constexpr double kC1 = 0.01 * 0.01;
  constexpr double kC2 = 0.03 * 0.03;
  const Plane plane_a = luma(a);
  const Plane plane_b = luma(b);
  const std::vector<double> mean_a = window_means(plane_a);
  const std::vector<double> mean_b = window_means(plane_b);
  const std::vector<double> mean_aa = window_means(product(plane_a, plane_a));
  const std::vector<double> mean_bb = window_means(product(plane_b, plane_b));
  const std::vector<double> mean_ab = window_means(product(plane_a, plane_b));

  double sum = 0;
  for (std::size_t i = 0; i < mean_a.size(); ++i) {
    const double variance_a = mean_aa[i] - mean_a[i] * mean_a[i];
    const double variance_b = mean_bb[i] - mean_b[i] * mean_b[i];
    const double covariance = mean_ab[i] - mean_a[i] * mean_b[i];
    const double means =
        (2 * mean_a[i] * mean_b[i] + kC1) / (mean_a[i] * mean_a[i] + mean_b[i] * mean_b[i] + kC1);
    sum += means * (2 * covariance + kC2) / (variance_a + variance_b + kC2);
  }
  return sum / static_cast<double>(mean_a.size());
}

double mean_flip(const Image& image, const Image& reference, double pixels_per_degree) {
  require_comparable(image, reference);
  return FlipReference(reference, pixels_per_degree).mean(image);
}

FlipReference::FlipReference(const Image& reference, double pixels_per_degree)
    : width_(reference.width), height_(reference.height), pixels_per_degree_(pixels_per_degree) {
  require_measurable(reference);
  if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1000)) {
    throw std::invalid_argument("FLIP is defined here for 1 to 1000 pixels per degree");
  }
  seen_ = std::make_shared<const flip::Seen>(flip::seen(reference, pixels_per_degree));
}

std::vector<double> FlipReference::map(const Image& image) const {
  require_same_size(image.width, image.height, width_, height_);
  require_measurable(image);
  return flip::error_map(flip::seen(image, pixels_per_degree_), *seen_);
}

double FlipReference::mean(const Image& image) const {
  const std::vector<double> errors = map(image);
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

double flicker(const Image& before, const Image& now, const Image& reference_before,
               const Image& reference_now) {
  require_comparable(before, reference_before);
  require_comparable(now, reference_now);
  require_comparable(before, now);
  double squares = 0;
  for (std::size_t i = 0; i < now.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double change = double{now.pixels[i][c]} - double{before.pixels[i][c]};
      const double due = double{reference_now.pixels[i][c]} - double{reference_before.pixels[i][c]};
      squares += (change - due) * (change - due);
    }
  }
  return std::sqrt(squares / (3 * static_cast<double>(now.pixels.size())));
}

Image clamped_to_display(const Image& image) {
  Image result = image;
  for (Color& colour : result.pixels) {
    for (int c = 0; c < 3; ++c) colour[c] = std::clamp(colour[c], 0.0f, 1.0f);
  }
  return result;
}

Image difference_picture(const Image& image, const Image& reference) {
  require_comparable(image, reference);
  double largest = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    largest = std::max(largest, pixel_error(image.pixels[i], reference.pixels[i]));
  }
  const double scale = largest > 0 ? 1 / largest : 0;
  Image result(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(double{image.pixels[i][c]} - double{reference.pixels[i][c]});
      result.pixels[i][c] = static_cast<float>(error * scale);
    }
  }
  return result;
}

}  // namespace pprt
