// What the ranks need to know of a sampler. Each sampler states it of itself; nobody asks which one it is.
#pragma once

#include <cstdint>

namespace pprt {

// What is done with a sample: the work clock prices it (parallel/settings/work_units.h).
enum class SampleStore : std::uint8_t {
  kTriangulation,  // it makes triangles, which are queued and painted
  kLattice         // it is a node, whose neighbours learn from it
};

// What cast samples are to the next picture.
enum class CastUse : std::uint8_t {
  kSamples,  // samples of it, if they are visible
  kLights    // they tell which lights are seen near them
};

struct SamplerTraits {
  int tile_multiple = 1;  // a tile's side is a multiple of so many pixels
  SampleStore store = SampleStore::kLattice;
  double still_weight = 0;  // mean weight at which a still looks converged; 0: all its points are sampled
  bool weights_are_roots = false;  // quality() tells the square roots of the weights that is_refined_to() and
                                   // still_weight are about
  CastUse cast_use = CastUse::kLights;
  bool refreshes_in_parts = false;     // repaint() brings tiles up to date one by one
  bool balances_without_rate = false;  // tiles change hands in frames without a rate, too
  bool costs_outlast_rest =
      false;  // what tiles cost a picture at rest tells what they cost one that begins anew
};

}  // namespace pprt
