// The pixels of one rank's region (paper s. 2.2, 3.7).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pipeline/sampling/sampler.h"

namespace pprt {

class PictureRefresh {
 public:
  // Reconstructs the region's pixels, and those of further tiles that the samples cover.
  void reconstruct(Sampler& sampler, std::span<const std::int32_t> further_tiles);

  // The next picture shows something else: it is reconstructed as a whole.
  void forget() { tiles_.clear(); }

  // Brings a picture up to date that shows the same as before, with more samples. Before each tile it asks
  // whether time is over. The tiles that have waited longest come first. Returns the share of the tiles that
  // were reconstructed: all of them where the region has changed, none where no sample has come.
  double refresh(Sampler& sampler, const std::function<bool()>& is_over);

  // Appends the pixels of a tile to `colors`, rows from the top.
  void append_tile(const TileGrid& grid, int tile, std::vector<Color>& colors) const;

  const PixelBlock& pixels() const { return pixels_; }

 private:
  PixelBlock pixels_;
  std::vector<std::int32_t> tiles_;  // of the region, those that have waited longest first
  std::vector<std::size_t>
      shows_;  // per tile of the image: samples that there were when it was reconstructed
};

}  // namespace pprt
