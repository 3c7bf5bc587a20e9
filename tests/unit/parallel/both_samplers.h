// Tests of what holds on the lattice and on the triangulation: written once, run and listed once for each.
#pragma once

#include <catch2/catch.hpp>

#include "parallel/settings/session_settings.h"

#define PPRT_JOINED_(a, b) a##b
#define PPRT_JOINED(a, b) PPRT_JOINED_(a, b)

#define PPRT_TESTS_OF_(body, name, ...)                      \
  static void body(SamplerChoice sampler);                   \
  TEST_CASE(name " (lattice)" __VA_OPT__(, ) __VA_ARGS__) {  \
    body(SamplerChoice::kAuto);                              \
  }                                                          \
  TEST_CASE(name " (delaunay)" __VA_OPT__(, ) __VA_ARGS__) { \
    body(SamplerChoice::kDelaunay);                          \
  }                                                          \
  static void body(SamplerChoice sampler)

// Use it like TEST_CASE, in namespace pprt. The body finds the sampler in `sampler`.
#define BOTH_SAMPLERS_TEST_CASE(...) PPRT_TESTS_OF_(PPRT_JOINED(of_both_samplers_, __LINE__), __VA_ARGS__)
