// How far a region is refined: what balancing goes by, whichever sampler took the samples.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/core/region.h"

namespace pprt {

// Sums over a tile of what may be refined in it (paper s. 4.4: LastTotalWeight, LastTotalNum). Triangulations
// sum over the triangles whose refinement point lies in the tile, lattices over their candidates.
struct TileWeights {
  double total_weight = 0;
  std::int64_t count = 0;
  std::int64_t mixed_pixels = 0;  // that show several surfaces, as far as that is known
};

struct RegionQuality {
  const Region& region;
  std::span<const TileWeights> tiles;  // of the grid; zero outside the region
  double mean_weight = 0;              // Q_k of the region (paper s. 3.6), 0 without any; smaller is better

  const TileWeights& tile(int number) const { return tiles[static_cast<std::size_t>(number)]; }
};

}  // namespace pprt
