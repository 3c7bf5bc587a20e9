// Logarithms of positive, normal floats from their bits: whole steps, a fixed number of them an octave.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <type_traits>

#include "base/simd.h"

namespace pprt {

// The whole numbers in a float's place: one for float, four for float4.
template <class Number>
using BitsOf = std::conditional_t<std::is_same_v<Number, float>, std::int32_t, int4>;

// Returns the step that holds a number, or four: 2^kFine steps an octave, and with kFine = -1 one in two
// octaves.
template <int kFine, class Number>
BitsOf<Number> octave_step(const Number& x) {
  return std::bit_cast<BitsOf<Number>>(x) >> (23 - kFine);
}

// Returns the step that begins at 2^exponent.
template <int kFine>
constexpr std::int32_t step_of_power(int exponent) {
  constexpr int kBias = 127;  // of a float's exponent
  return kFine >= 0 ? (exponent + kBias) << kFine : (exponent + kBias) >> -kFine;
}

// Returns the least number of a step.
template <int kFine>
float least_of_step(std::int32_t step) {
  return std::bit_cast<float>(step << (23 - kFine));
}

// A squared error on the display scale by its octave. The lowest level: below 2^-14. The highest: 1.
inline constexpr int kErrorLevels = 16;
inline int error_level(float squared_error) {
  constexpr std::int32_t kLeast = step_of_power<0>(1 - kErrorLevels);
  return std::clamp(octave_step<0>(squared_error) - kLeast, 0, kErrorLevels - 1);
}

// The variance of colours, or of four, in steps of two octaves from 2^-17 on. Not negative, at most 8 for
// what a display shows.
inline constexpr int kVarianceLevels = 8;
template <class Number>
BitsOf<Number> variance_level(const Number& variance) {
  const BitsOf<Number> above = octave_step<-1>(variance) - step_of_power<-1>(-17);
  return above & ~(above >> 31);  // not below 0
}

// Returns the natural logarithm of one positive, normal float or of four, with a relative error below 4e-7;
// of 1 exactly 0. The polynomial is the minimax one (Remez) for log(1 + f) / f over [sqrt(1/2), sqrt(2)] - 1.
// Scalar twin: the instance for one float.
template <class Number>
Number fast_logarithm(const Number& x) {
  using Bits = std::conditional_t<std::is_same_v<Number, float>, std::int32_t, int4>;
  constexpr std::int32_t kRootOfHalf = 0x3f3504f3;
  const Bits bits = std::bit_cast<Bits>(x), exponent = (bits - kRootOfHalf) >> 23;
  const Number f = std::bit_cast<Number>(bits - (exponent << 23)) - 1;
  const Number high = 0.199001655F + f * (-0.172508298F + f * (0.162225803F + f * -0.10106895F));
  const Number all = 0.999999945F + f * (-0.500003651F + f * (0.333350589F + f * (-0.249699091F + f * high)));
  return f * all + as_numbers<Number>(exponent) * 0.693147181F;
}

}  // namespace pprt
