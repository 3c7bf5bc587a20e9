// What pprt-compare tells of a pair of pictures: each figure with its names, its limit, and which value is
// the worse.
#pragma once

#include <array>
#include <optional>

#include "compare/compare.h"
#include "image/image.h"

namespace pprt {

struct Figures {
  ImageDifference difference;
  double flip = 0;
};

// Throws as `difference` and `mean_flip` (image/metrics.h).
Figures figures_of(const Image& image, const Image& reference, const CompareOptions& options);

enum class Best { kSmall, kLarge, kNearZero };

struct FigureKind {
  const char* key;    // in JSON and complaints
  const char* label;  // for people
  Best best;
  double (*of)(const Figures&);
  const char* option = nullptr;  // of the limit; none for some
  std::optional<double> CompareOptions::*limit = nullptr;

  // A value that is not a number is worse than any other.
  bool is_worse(double a, double b) const;
  // The limit when the value has passed it; a limit that is not a number is always passed.
  std::optional<double> passed_limit(double value, const CompareOptions& options) const;
};

inline constexpr std::size_t kFigureCount = 9;
extern const std::array<FigureKind, kFigureCount> kFigures;  // in the order of telling

// The sequence's own figure, of two pairs of neighbouring frames.
extern const FigureKind kFlicker;

}  // namespace pprt
