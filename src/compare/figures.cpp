#include "compare/figures.h"

#include <cmath>

namespace pprt {

const std::array<FigureKind, kFigureCount> kFigures{{
    {"rmse", "rmse", Best::kSmall, [](const Figures& f) { return f.difference.rmse; }, "--max-rmse",
     &CompareOptions::max_rmse},
    {"psnr", "psnr, dB", Best::kLarge, [](const Figures& f) { return f.difference.psnr; }, "--min-psnr",
     &CompareOptions::min_psnr},
    {"relative_mse", "relative mse", Best::kSmall, [](const Figures& f) { return f.difference.relative_mse; },
     "--max-relative-mse", &CompareOptions::max_relative_mse},
    {"ssim", "ssim", Best::kLarge, [](const Figures& f) { return f.difference.ssim; }, "--min-ssim",
     &CompareOptions::min_ssim},
    {"flip", "flip", Best::kSmall, [](const Figures& f) { return f.flip; }, "--max-flip",
     &CompareOptions::max_flip},
    {"max_error", "max error", Best::kSmall, [](const Figures& f) { return f.difference.max_error; },
     "--max-error", &CompareOptions::max_error},
    {"error_p999", "99.9 % error", Best::kSmall, [](const Figures& f) { return f.difference.error_p999; },
     "--max-p999", &CompareOptions::max_p999},
    {"share", "share", Best::kSmall, [](const Figures& f) { return f.difference.share_over_threshold; },
     "--max-share", &CompareOptions::max_share},
    {"signed_mean", "signed mean", Best::kNearZero,
     [](const Figures& f) { return f.difference.signed_mean; }},
}};

const FigureKind kFlicker{"flicker", "flicker",       Best::kSmall,
                          nullptr,   "--max-flicker", &CompareOptions::max_flicker};

Figures figures_of(const Image& image, const Image& reference, const CompareOptions& options) {
  return {difference(image, reference, options.threshold),
          mean_flip(image, reference, options.pixels_per_degree)};
}

bool FigureKind::is_worse(double a, double b) const {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && !std::isnan(b);
  switch (best) {
    case Best::kSmall:
      return a > b;
    case Best::kLarge:
      return a < b;
    case Best::kNearZero:
      return std::abs(a) > std::abs(b);
  }
  return false;
}

std::optional<double> FigureKind::passed_limit(double value, const CompareOptions& options) const {
  if (!limit || !(options.*limit)) return std::nullopt;
  const double bound = *(options.*limit);
  const bool held = best == Best::kLarge ? value >= bound : value <= bound;
  return held ? std::nullopt : std::optional(bound);
}

}  // namespace pprt
