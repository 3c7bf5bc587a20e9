#include "base/simd.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "pipeline/mesh/refinement_weight.h"

namespace pprt::simd_test {
namespace {

float4 random_lanes(std::mt19937& random) {
  std::uniform_real_distribution<float> number(-2, 2);
  return float4{number(random), number(random), number(random), number(random)};
}

}  // namespace

TEST_CASE("vectors of four: minimum, maximum and size are those of each lane") {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const float4 a = random_lanes(random), b = i % 10 == 0 ? a : random_lanes(random);
    const float4 low = min(a, b), high = max(a, b), sizes = abs(a);
    for (int lane = 0; lane < kLanes; ++lane) {
      CHECK(low[lane] == std::min(a[lane], b[lane]));
      CHECK(high[lane] == std::max(a[lane], b[lane]));
      CHECK(sizes[lane] == std::abs(a[lane]));
    }
  }
}

TEST_CASE("vectors of four: transposing exchanges rows and columns") {
  std::array<float4, 4> rows = {{{0, 1, 2, 3}, {10, 11, 12, 13}, {20, 21, 22, 23}, {30, 31, 32, 33}}};
  transpose(rows[0], rows[1], rows[2], rows[3]);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) CHECK(rows[static_cast<std::size_t>(i)][j] == static_cast<float>(10 * j + i));
  }
}

TEST_CASE("vectors of four: any() sees a comparison that holds in a single lane") {
  CHECK_FALSE(any(float4{1, 2, 3, 4} < 1));
  for (int lane = 0; lane < kLanes; ++lane) {
    float4 v = {1, 2, 3, 4};
    v[lane] = 0;
    CHECK(any(v < 1));
  }
}

TEST_CASE("vectors of four: a colour is read without what follows it, and written without touching that") {
  struct {
    Color color{0.25F, 0.5F, 0.75F};
    float beside = std::numeric_limits<float>::quiet_NaN();
  } entry;
  const float4 channels = channels_before_more(&entry.color);
  CHECK((channels[0] == 0.25F && channels[1] == 0.5F && channels[2] == 0.75F));
  CHECK(channels[3] == 0);
  entry.beside = 7;
  store_channels(float4{1, 2, 3, 4}, entry.color);
  CHECK(entry.color == Color(1, 2, 3));
  CHECK(entry.beside == 7);
}

TEST_CASE("vectors of four: clamping a colour to the display scale is clamping each channel") {
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const float4 v = random_lanes(random), clamped = on_display(v);
    for (int channel = 0; channel < 3; ++channel) CHECK(clamped[channel] == held_to_unit(v[channel]));
    CHECK(clamped[3] == 0);
  }
}

}  // namespace pprt::simd_test
