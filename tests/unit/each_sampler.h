// Tests of what holds on every sampler: written once, run and listed once for each of the table of samplers.
// Other orders of the points of one are left out.
#pragma once

#include <array>
#include <catch2/catch.hpp>

#include "parallel/settings/sampler_list.h"
#include "parallel/settings/session_settings.h"

#define PPRT_JOINED_(a, b) a##b
#define PPRT_JOINED(a, b) PPRT_JOINED_(a, b)

#define PPRT_NO_TEST_(...)
#define PPRT_TEST_(choice, word, help, kind, body, name, ...) \
  TEST_CASE(name " (" word ")" __VA_OPT__(, ) __VA_ARGS__) {  \
    body(SamplerChoice::choice);                              \
  }
#define PPRT_TESTS_OF_(body, ...)                             \
  static void body(SamplerChoice sampler);                    \
  PPRT_SAMPLERS(PPRT_TEST_, PPRT_NO_TEST_, body, __VA_ARGS__) \
  static void body(SamplerChoice sampler)

// Use it like TEST_CASE, in namespace pprt. The body finds the sampler in `sampler`.
#define EACH_SAMPLER_TEST_CASE(...) PPRT_TESTS_OF_(PPRT_JOINED(of_each_sampler_, __LINE__), __VA_ARGS__)

namespace pprt {

// For tests that compare what samplers make.
#define PPRT_LISTED_(choice, ...) SamplerChoice::choice,
inline constexpr std::array kEachSampler = {PPRT_SAMPLERS(PPRT_LISTED_, PPRT_NO_TEST_)};
#undef PPRT_LISTED_

}  // namespace pprt
