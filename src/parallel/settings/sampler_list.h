// The samplers that there are, a row each. SamplerChoice comes from here, and so do the words of --sampler
// with their help. parallel/exchange/samplers.cpp makes a sampler by its row, and tests/unit/each_sampler.h
// tests each. docs/extending.md shows how to add one.
#pragma once

// Calls sampler(CHOICE, WORD, HELP, KIND, ...) for each sampler, and order(the same) for another order of the
// points of one above. KIND is a type of parallel/exchange/samplers.cpp, and `...` what the caller adds.
// clang-format off
#define PPRT_SAMPLERS(sampler, order, ...) \
  sampler(kAuto, "auto", "a grid, then what is most wrong", AdaptiveLattice, __VA_ARGS__) \
  sampler(kDelaunay, "delaunay", "the heaviest triangles, as in the paper", Triangulation, __VA_ARGS__) \
  order(kGrid, "grid", "evenly, ever finer", LevelledLattice, __VA_ARGS__)
// clang-format on
