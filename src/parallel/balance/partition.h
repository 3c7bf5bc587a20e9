// Which rank owns which tile: data, not code (paper s. 3.3, 4.4).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/core/region.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

// Invariant: exactly one owner a tile, each in [0, ranks). Only a tile's owner gives it away, and with a
// higher version; so the highest version names the owner, in whatever order messages arrive.
struct Partition {
  TileGrid grid;
  int ranks = 1;
  std::vector<std::int32_t> owner;  // per tile
  std::vector<std::uint64_t>
      version;  // per tile: generation of the partition << 32 | times transferred since

  int owner_at(double x, double y) const { return owner[static_cast<std::size_t>(grid.tile_at(x, y))]; }
};

// First version of the tiles of a generation: higher than any of the generation before.
inline std::uint64_t first_version(std::uint32_t generation) {
  return std::uint64_t{generation} << 32;
}

// Returns a grid of square tiles: about 100 a rank so that balancing can be fine, 2 to 32 pixels wide. Their
// side is a multiple of a number of pixels, at most 32.
TileGrid tile_grid_for(int width, int height, int ranks, int multiple_of = 1);

// Partitions the image by greedy recursive bisection (paper s. 4.4). Each cut runs across the longer side, at
// the tile line where both sides' `tile_costs` are nearest to their shares of the ranks' `speeds`. Regions
// are rectangles. A rank without speed owns no tile, and with fewer tiles than ranks some others own none.
// Costs and speeds must not be negative, one speed at least greater than 0; costs that are all zero count as
// all equal.
Partition bisect(const TileGrid& grid, std::span<const double> tile_costs, std::span<const double> speeds);

// The same for ranks of equal speed.
Partition bisect(const TileGrid& grid, std::span<const double> tile_costs, int ranks);

// Returns the tiles that share a side with this one, at most four.
std::vector<int> tiles_beside(const TileGrid& grid, int tile);

Region region_of(const Partition& partition, int rank);

// Other ranks with a tile beside one of the rank's own, corner to corner included; ascending.
std::vector<int> ranks_beside(const Partition& partition, int rank);

// Whether the rank's tiles are connected by their sides; true for an empty region.
bool is_connected(const Partition& partition, int rank);

}  // namespace pprt
