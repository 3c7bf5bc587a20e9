// A partition that tests of balancing share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallel/balance/partition.h"

namespace pprt::test {

// Two ranks side by side on 8 x 4 tiles of 10 pixels; the left four columns are rank 0's.
inline Partition halves() {
  const TileGrid grid(80, 40, 10);
  Partition partition{grid, 2, std::vector<std::int32_t>(32), std::vector<std::uint64_t>(32, 0)};
  for (int tile = 0; tile < 32; ++tile)
    partition.owner[static_cast<std::size_t>(tile)] = tile % 8 < 4 ? 0 : 1;
  return partition;
}

}  // namespace pprt::test
