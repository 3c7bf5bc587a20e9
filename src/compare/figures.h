// The figures of a pair of pictures: names, limits, and which value is worse.
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

// Measures all figures. Throws as difference() and mean_flip() (image/metrics.h).
Figures figures_of(const Image& image, const Image& reference, const CompareOptions& options);

enum class Best { kSmall, kLarge, kNearZero };

struct FigureKind {
  const char* key;    // in JSON and complaints
  const char* label;  // for people
  Best best;
  double (*of)(const Figures&);
  const char* option = nullptr;  // that sets the limit; null: none
  std::optional<double> CompareOptions::*limit = nullptr;

  // Whether `a` is worse than `b`. NaN is worse than any number.
  bool is_worse(double a, double b) const;
  // Returns the limit when the value exceeds it. A limit of NaN is always exceeded.
  std::optional<double> exceeded_limit(double value, const CompareOptions& options) const;
};

inline constexpr std::size_t kFigureCount = 9;
extern const std::array<FigureKind, kFigureCount> kFigures;  // in the order of printing

// The figure of a sequence alone, from pairs of neighbouring frames.
extern const FigureKind kFlicker;

}  // namespace pprt
