// Corrects the weights of triangles by what refinement has learned: how wrong the picture proved to be where
// samples came, against what the weights had predicted (docs/decisions/0018-learned-weights.md).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pipeline/core/octaves.h"

namespace pprt {

// A sample's contribution to the bin of its triangles: the octave of the error that the picture had there
// before, and the octave of the number of rays it took. The features of three corners add up without a carry
// from one part to the other.
using Feature = std::int16_t;
inline constexpr std::int32_t kRayOctaves = 4;     // 1, 2 and 3, 4 to 7, 8 and more
inline constexpr std::int32_t kPerRayOctave = 64;  // above three of the highest error octave

// `squared_error` on the display scale; `rays` at least 1.
inline Feature feature_of(float squared_error, std::uint32_t rays) {
  const std::int32_t octave_of_rays = std::bit_width(rays) - 1;
  return static_cast<Feature>(error_level(squared_error) +
                              std::clamp(octave_of_rays, 0, kRayOctaves - 1) * kPerRayOctave);
}

// A class of triangles that learn together. It has four parts, from the highest bits:
// - the sum of the corners' ray octaves, in steps of two
// - the number of primitives under the corners
// - the octave of their colours' variance, in steps of two
// - the sum of their error octaves, in steps of eight
using Bin = std::uint32_t;
inline constexpr std::size_t kBins = std::size_t{5} * 4 * 8 * 8;

// Returns the bin of one triangle (float, std::int32_t) or of four (float4, int4). Takes the primitives under
// the corners, the variance of their colours, and the sum of their features.
// Scalar twin: the instance for one triangle.
template <class Number, class Whole>
Whole bin_of(const Whole& a, const Whole& b, const Whole& c, const Number& variance, const Whole& features) {
  const auto as_one = [](const auto& truth) {
    if constexpr (std::is_same_v<Whole, std::int32_t>) {
      return static_cast<Whole>(truth);
    } else {
      return truth & 1;
    }
  };
  const Whole rays = features >> 7, errors = (features & (kPerRayOctave - 1)) >> 3;
  const Whole more_primitives = as_one(a != b) + as_one((c != a) & (c != b));
  return (rays << 8) + (more_primitives << 6) + (variance_level(variance) << 3) + errors;
}

// Factors by which weights were too small or too large, per bin. A weight's prediction is compared with the
// squared error times the triangle's area, per time that the sample took.
class LearnedWeights {
 public:
  LearnedWeights() {
    for (std::size_t bin = 0; bin < kBins; ++bin) corrections_[bin] = tempered(expected()[bin % kExpected]);
  }

  // Returns the factor to multiply a weight with. It is above 1 for bins that were worse than the average of
  // all bins when something was last learned of them.
  float correction(Bin bin) const { return corrections_[bin]; }

  // Learns from a sample that refined a triangle of this bin and weight. The picture there was wrong by
  // `squared_error` over `area` square pixels; the sample's ray tree has `rays` rays.
  void learn(Bin bin, float weight, float squared_error, float area, std::uint32_t rays) {
    if (!(weight > 0)) return;          // it predicted nothing
    constexpr float kInsertion = 2.5F;  // an insertion's time in rays; reconstruction is left out
    constexpr float kDoubt = 10;        // samples that the initial expectation counts as
    const Evidence found{squared_error * area / weight, kInsertion + static_cast<float>(rays)};
    Evidence& of_bin = bins_[bin];
    of_bin.remember(found, 1.0F / 512), all_.remember(found, 1.0F / 4096);
    samples_ += 1 - samples_ * (1.0F / 4096);
    const float error = of_bin.error * samples_ + all_.error * kDoubt * expected()[bin % kExpected];
    const float time = of_bin.time * samples_ + all_.time * kDoubt;
    if (all_.error > 0) corrections_[bin] = tempered(error * all_.time / (time * all_.error));
  }

 private:
  // Sums over about the last 1 / `forgotten` samples.
  struct Evidence {
    float error = 0, time = 0;

    void remember(const Evidence& more, float forgotten) {
      error += more.error - error * forgotten;
      time += more.time - time * forgotten;
    }
  };

  // Errors expected before anything is learned, by the lowest bits of the bin. They are larger where corners
  // came as a surprise, and where corners lie on three primitives, for there may be more between them.
  static constexpr std::size_t kExpected = 4 * 8 * 8;
  static const std::array<float, kExpected>& expected() {
    static const std::array<float, kExpected> table = [] {
      constexpr float kStep = 1.23114441F;    // .3 octaves
      constexpr float kLeast = 0.594603558F;  // two and a half such steps below 1
      std::array<float, kExpected> by_bin{};
      for (std::size_t bin = 0; bin < kExpected; ++bin) {
        by_bin[bin] = kLeast;
        for (std::size_t step = (bin & 7) + (bin >> 6 == 2 ? 1 : 0); step > 0; --step) by_bin[bin] *= kStep;
      }
      return by_bin;
    }();
    return table;
  }

  // Returns ratio^(3/4), for what is learned is uncertain, held to [1/32, 32].
  static float tempered(float ratio) {
    constexpr float kMost = 32;
    const float root = std::sqrt(ratio), power = root * std::sqrt(root);
    const float from_below = power > 1 / kMost ? power : 1 / kMost;
    return from_below < kMost ? from_below : kMost;
  }

  std::array<Evidence, kBins> bins_{};
  Evidence all_;
  float samples_ = 0;  // in all_
  std::array<float, kBins> corrections_{};
};

}  // namespace pprt
