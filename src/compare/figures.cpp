#include "compare/figures.h"

#include <cmath>

namespace pprt {

const std::array<FigureKind, kFigureCount> kFigures{{
    {.key = "rmse",
     .label = "rmse",
     .best = Best::kSmall,
     .of = [](const Figures& f) { return f.difference.rmse; },
     .option = "--max-rmse",
     .limit = &CompareOptions::max_rmse},
    {.key = "psnr",
     .label = "psnr, dB",
     .best = Best::kLarge,
     .of = [](const Figures& f) { return f.difference.psnr; },
     .option = "--min-psnr",
     .limit = &CompareOptions::min_psnr},
    {.key = "relative_mse",
     .label = "relative mse",
     .best = Best::kSmall,
     .of = [](const Figures& f) { return f.difference.relative_mse; },
     .option = "--max-relative-mse",
     .limit = &CompareOptions::max_relative_mse},
    {.key = "ssim",
     .label = "ssim",
     .best = Best::kLarge,
     .of = [](const Figures& f) { return f.difference.ssim; },
     .option = "--min-ssim",
     .limit = &CompareOptions::min_ssim},
    {.key = "flip",
     .label = "flip",
     .best = Best::kSmall,
     .of = [](const Figures& f) { return f.flip; },
     .option = "--max-flip",
     .limit = &CompareOptions::max_flip},
    {.key = "max_error",
     .label = "max error",
     .best = Best::kSmall,
     .of = [](const Figures& f) { return f.difference.max_error; },
     .option = "--max-error",
     .limit = &CompareOptions::max_error},
    {.key = "error_p999",
     .label = "99.9 % error",
     .best = Best::kSmall,
     .of = [](const Figures& f) { return f.difference.error_p999; },
     .option = "--max-p999",
     .limit = &CompareOptions::max_p999},
    {.key = "share",
     .label = "share",
     .best = Best::kSmall,
     .of = [](const Figures& f) { return f.difference.share_over_threshold; },
     .option = "--max-share",
     .limit = &CompareOptions::max_share},
    {.key = "signed_mean",
     .label = "signed mean",
     .best = Best::kNearZero,
     .of = [](const Figures& f) { return f.difference.signed_mean; }},
}};

const FigureKind kFlicker{.key = "flicker",
                          .label = "flicker",
                          .best = Best::kSmall,
                          .of = nullptr,
                          .option = "--max-flicker",
                          .limit = &CompareOptions::max_flicker};

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

std::optional<double> FigureKind::exceeded_limit(double value, const CompareOptions& options) const {
  if (!limit || !(options.*limit)) return std::nullopt;
  const double bound = *(options.*limit);
  const bool held = best == Best::kLarge ? value >= bound : value <= bound;
  return held ? std::nullopt : std::optional(bound);
}

}  // namespace pprt
