// What refinement learns as it goes: how wrong a picture proves to be where samples come, in triangles of one
// kind, against what their weights had said.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pipeline/simd.h"

namespace pprt {

// What a triangle's kind takes from a corner: how wrong the picture was where that sample came, and how many
// rays it took, to their octaves. Traits of corners add up without mixing the two.
using Trait = std::int16_t;
inline constexpr std::int32_t kErrorOctaves = 16;  // the lowest: below 2^-14; the highest: 1
inline constexpr std::int32_t kRayOctaves = 4;     // 1, 2 and 3, 4 to 7, 8 and more
inline constexpr std::int32_t kPerRayOctave = 64;  // above three of the highest error octave

// Of a squared error on the display scale.
inline Trait trait_of(float squared_error, std::uint32_t rays) {
  constexpr std::int32_t kLeast = 127 - (kErrorOctaves - 1);  // as a float's exponent
  const std::int32_t error = (std::bit_cast<std::int32_t>(squared_error) >> 23) - kLeast;
  const std::int32_t octave_of_rays = std::bit_width(rays) - 1;
  return static_cast<Trait>(std::clamp(error, 0, kErrorOctaves - 1) +
                            std::clamp(octave_of_rays, 0, kRayOctaves - 1) * kPerRayOctave);
}

// Kinds of triangles: by the sum of their corners' octaves of rays in twos, how many primitives the corners
// lie on, the octaves of their colours' variance in twos, and the sum of their octaves of errors in eights.
using TriangleKind = std::uint32_t;
inline constexpr std::size_t kTriangleKinds = std::size_t{5} * 4 * 8 * 8;

// Of one triangle, or of four: the primitives that its corners lie on, the variance of their colours, and the
// sum of their traits.
template <class Number, class Whole>
Whole triangle_kind(const Whole& a, const Whole& b, const Whole& c, const Number& variance,
                    const Whole& traits) {
  constexpr std::int32_t kLeast = 55;  // half the exponent of a float of 2^-17
  const auto as_one = [](const auto& truth) {
    if constexpr (std::is_same_v<Whole, std::int32_t>) {
      return static_cast<Whole>(truth);
    } else {
      return truth & 1;
    }
  };
  const Whole rays = traits >> 7, errors = (traits & (kPerRayOctave - 1)) >> 3;
  const Whole more_primitives = as_one(a != b) + as_one((c != a) & (c != b));
  const Whole above = (std::bit_cast<Whole>(variance) >> 24) - kLeast;
  const Whole spread = above & ~(above >> 31);  // not below 0
  return (rays << 8) + (more_primitives << 6) + (spread << 3) + errors;
}

// By how much weights have said too much or too little, to be multiplied with them. What a weight had said is
// compared with the squared error times the triangle's area, and with the time that its sample took.
class LearnedWeights {
 public:
  LearnedWeights() {
    for (std::size_t kind = 0; kind < kTriangleKinds; ++kind)
      corrections_[kind] = tempered(expected()[kind % kExpected]);
  }

  // Above 1 for kinds that have proved worse than all together when they were last learned of.
  float correction(TriangleKind kind) const { return corrections_[kind]; }

  // A sample has refined a triangle of the kind and of that weight. The picture there was wrong by
  // `squared_error` over `area` square pixels; the sample's ray tree has so many rays.
  void learn(TriangleKind kind, float weight, float squared_error, float area, std::uint32_t rays) {
    if (!(weight > 0)) return;          // it has said nothing
    constexpr float kInsertion = 2.5F;  // takes as long as so many rays; painting is left out
    constexpr float kDoubt = 10;        // what was expected counts as much as so many samples
    const Evidence found{squared_error * area / weight, kInsertion + static_cast<float>(rays)};
    Evidence& of_kind = kinds_[kind];
    of_kind.remember(found, 1.0F / 512), all_.remember(found, 1.0F / 4096);
    samples_ += 1 - samples_ * (1.0F / 4096);
    const float error = of_kind.error * samples_ + all_.error * kDoubt * expected()[kind % kExpected];
    const float time = of_kind.time * samples_ + all_.time * kDoubt;
    if (all_.error > 0) corrections_[kind] = tempered(error * all_.time / (time * all_.error));
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

  // As long as nothing is known: more error where corners came unforeseen, and where they lie on three
  // primitives, for there may be more of these between them. By the lowest bits of the kind.
  static constexpr std::size_t kExpected = 4 * 8 * 8;
  static const std::array<float, kExpected>& expected() {
    static const std::array<float, kExpected> table = [] {
      constexpr float kStep = 1.23114441F;    // .3 octaves
      constexpr float kLeast = 0.594603558F;  // two and a half such steps below 1
      std::array<float, kExpected> by_kind{};
      for (std::size_t kind = 0; kind < kExpected; ++kind) {
        by_kind[kind] = kLeast;
        for (std::size_t step = (kind & 7) + (kind >> 6 == 2 ? 1 : 0); step > 0; --step)
          by_kind[kind] *= kStep;
      }
      return by_kind;
    }();
    return table;
  }

  // To the power of 3/4, for what is learned is uncertain, and within bounds.
  static float tempered(float ratio) {
    constexpr float kMost = 32;
    const float root = std::sqrt(ratio), power = root * std::sqrt(root);
    const float from_below = power > 1 / kMost ? power : 1 / kMost;
    return from_below < kMost ? from_below : kMost;
  }

  std::array<Evidence, kTriangleKinds> kinds_{};
  Evidence all_;
  float samples_ = 0;  // in all_
  std::array<float, kTriangleKinds> corrections_{};
};

}  // namespace pprt
