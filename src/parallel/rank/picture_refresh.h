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

  // Returns the share of a region's tiles that the picture does not show.
  double unshown(const Region& region) const;

  // Brings a picture up to date that shows the same as before, with more samples. Tiles that it does not show
  // yet come first, then those that have waited longest. Before each of these it asks whether time is over.
  // Further tiles of which it shows something stay as they are. Returns the share of the tiles that were
  // reconstructed, none where no sample has come. Not `in_parts`: all of them where the region has changed,
  // or where there are further tiles.
  double refresh(Sampler& sampler, std::span<const std::int32_t> further_tiles, bool in_parts,
                 const std::function<bool()>& is_over);

  // Appends the pixels of a tile to `colors`, rows from the top.
  void append_tile(const TileGrid& grid, int tile, std::vector<Color>& colors) const;

  const PixelBlock& pixels() const { return pixels_; }

 private:
  std::vector<std::int32_t> keep_shown(const Region& region, std::span<const std::int32_t> further_tiles);
  void move_to(const PixelRect& bounds);
  bool shows_all_of(const Region& region, std::span<const std::int32_t> further_tiles) const;

  PixelBlock pixels_;
  std::vector<std::int32_t> tiles_;  // of the region, those that have waited longest first
  std::vector<std::size_t>
      shows_;  // per tile of the image: samples that there were when it was reconstructed
};

}  // namespace pprt
