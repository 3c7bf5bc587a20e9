// Figures of a recorded run: who owned which tile in each frame, and how even the loads were.
#pragma once

#include <cstdint>
#include <vector>

#include "render/trace/balance_trace.h"

namespace pprt {

struct FrameFigures {
  int frame = 1;                     // its number
  std::vector<std::int32_t> owners;  // per tile, at the frame's end
  bool repartitioned = false;        // by the master, before the frame
  int moved = 0;                     // tiles that had another owner at the end of the frame before
  int given = 0;                     // times that a rank gave a tile to a neighbour during the frame
  double deviation = 0;              // standard deviation of the ranks' loads by their mean
  double worst = 0;                  // largest load by the mean
};

// Returns the cost of bringing each tile of the grid to the mean weight of the whole image, work units.
std::vector<double> tile_costs(const TileGrid& grid, const TracedFrame& frame);

// Returns the load of each rank that is not lost (paper s. 4.4): the cost of its tiles by its pace. `owners`:
// per tile.
std::vector<double> loads(const TileGrid& grid, const TracedFrame& frame,
                          const std::vector<std::int32_t>& owners);

// Returns the figures of each frame. Before the first frame, ranks own equal areas. A tile that nobody
// reported keeps its owner of the frame before.
std::vector<FrameFigures> figures_of(const BalanceTrace& run);

}  // namespace pprt
