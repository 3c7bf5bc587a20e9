// A picture put together from the tiles that ranks send.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "image/image.h"
#include "parallel/network/messages.h"
#include "pipeline/tile_grid.h"

namespace pprt {

// Knows of every tile whose pixels it shows and of which frame. Nothing older ever replaces something newer,
// and in one frame nothing from a tile's former owner what its owner has sent.
class Mosaic {
 public:
  explicit Mosaic(const TileGrid& grid);

  // Throws ProtocolError on a message whose pixels are not those of its tiles.
  void paste(int from, const PixelMessage& message);

  // Takes tiles that nobody has sent from an earlier picture; returns how many.
  int fill_gaps(const Mosaic& before);

  const Image& image() const { return image_; }
  Image&& take_image() { return std::move(image_); }

  // Per tile: the rank whose pixels are shown; -1: nobody's.
  const std::vector<std::int32_t>& shown_ranks() const { return ranks_; }

 private:
  struct Age {
    std::int32_t frame = -1;  // index; -1: no pixels yet
    bool by_owner = false;
    bool operator<(const Age& o) const {
      return frame != o.frame ? frame < o.frame : !by_owner && o.by_owner;
    }
  };

  TileGrid grid_;
  Image image_;
  std::vector<std::int32_t> ranks_;
  std::vector<Age> ages_;  // per tile
};

}  // namespace pprt
