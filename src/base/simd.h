// Vectors of four numbers, in the compiler's own types.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "base/vector.h"

// Compiles a second copy of the function for hosts with AVX2, whose registers hold four doubles. The results
// are equal to the bit (docs/decisions/0003-instruction-sets.md). Flattened, so that callees are cloned too.
// Not for the thread sanitizer, whose library the choice between the copies would call before it is ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define PPRT_CLONED_FOR_WIDE_REGISTERS [[gnu::flatten, gnu::target_clones("default", "arch=x86-64-v3")]]
#else
#define PPRT_CLONED_FOR_WIDE_REGISTERS
#endif

namespace pprt {

inline constexpr int kLanes = 4;
using float4 = float __attribute__((vector_size(kLanes * sizeof(float))));
using double4 = double __attribute__((vector_size(kLanes * sizeof(double))));
using int4 = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

// Converts one whole number to float, or four.
template <class Number, class Whole>
Number as_numbers(const Whole& whole) {
  if constexpr (std::is_same_v<Number, float>) {
    return static_cast<float>(whole);
  } else {
    return __builtin_convertvector(whole, Number);
  }
}

template <class Lanes, class From>
Lanes load(const From* from) {
  Lanes v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class Lanes, class To>
void store(const Lanes& v, To* to) {
  std::memcpy(to, &v, sizeof v);
}

template <class Lanes>
Lanes min(const Lanes& a, const Lanes& b) {
  return a < b ? a : b;
}
template <class Lanes>
Lanes max(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}
template <class Lanes>
Lanes abs(const Lanes& a) {
  return a < 0 ? -a : a;
}

// Four roots at once, correctly rounded: the compiler would take them one by one.
inline float4 square_root(const float4& v) {
#if defined(__SSE__)
  return _mm_sqrt_ps(v);
#else
  float4 root;
  for (int i = 0; i < kLanes; ++i) root[i] = std::sqrt(v[i]);
  return root;
#endif
}

// Returns red, green, blue and 0. Reads 16 bytes: four more bytes must follow the colour in memory.
inline float4 channels_before_more(const void* color) {
  return std::bit_cast<float4>(std::bit_cast<int4>(load<float4>(color)) & int4{-1, -1, -1, 0});
}
inline void store_channels(const float4& channels, Color& color) {
  std::memcpy(static_cast<void*>(&color), &channels, sizeof color);
}

// Converts four bytes. By interleaving with zeros: the compiler would convert them one by one.
inline float4 numbers_of(const std::array<std::uint8_t, kLanes>& bytes) {
  static_assert(std::endian::native == std::endian::little);
  using SixteenBytes = std::uint8_t __attribute__((vector_size(sizeof(float4))));
  using EightWords = std::uint16_t __attribute__((vector_size(sizeof(float4))));
  const auto in_lane = std::bit_cast<SixteenBytes>(int4{std::bit_cast<std::int32_t>(bytes), 0, 0, 0});
  const auto words = std::bit_cast<EightWords>(__builtin_shufflevector(
      in_lane, SixteenBytes{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
  const auto whole =
      std::bit_cast<int4>(__builtin_shufflevector(words, EightWords{}, 0, 8, 1, 9, 2, 10, 3, 11));
  return __builtin_convertvector(whole, float4);
}

// Whether a comparison holds in any lane.
inline bool any(const int4& lanes) {
  using Halves = std::int64_t __attribute__((vector_size(sizeof(int4))));
  const auto halves = std::bit_cast<Halves>(lanes);
  return (halves[0] | halves[1]) != 0;
}

// Transposes the 4 x 4 matrix whose rows are a, b, c and d.
template <class Lanes>
void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5),
              ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Lanes cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5),
              cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace pprt
