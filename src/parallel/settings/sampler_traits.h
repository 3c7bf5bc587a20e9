// What the ranks need to know of a sampler. Each sampler states it of itself
// (parallel/exchange/samplers.cpp); nobody asks which one it is.
#pragma once

#include <cstdint>

#include "parallel/settings/work_units.h"

namespace pprt {

// What cast samples are to the next picture.
enum class CastUse : std::uint8_t {
  kSamples,  // samples of it, if they are visible
  kLights    // they tell which lights are seen near them
};

struct SamplerTraits {
  int tile_multiple = 1;    // a tile's side is a multiple of so many pixels
  SampleWork work = {};     // what it does with a sample, for the work clock's prices
  double still_weight = 0;  // mean weight at which a still looks converged; 0: all its points are sampled
  CastUse cast_use = CastUse::kSamples;
  bool refreshes_in_parts = false;     // repaint() brings tiles up to date one by one
  bool balances_without_rate = false;  // tiles change hands in frames without a rate, too
  bool costs_outlast_rest =
      false;  // what tiles cost a picture at rest tells what they cost one that begins anew
};

}  // namespace pprt
