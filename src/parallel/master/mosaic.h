// A picture put together from the tiles that ranks send.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "image/image.h"
#include "parallel/protocol/messages.h"
#include "pipeline/core/tile_grid.h"

namespace pprt {

// Remembers for every tile whose pixels it shows and of which frame. Older pixels never replace newer ones.
// In one frame pixels of a tile's former owner never replace those of its owner.
class Mosaic {
 public:
  explicit Mosaic(const TileGrid& grid);

  // Pastes the tiles of a message from the rank, where they are newer than what is shown. Throws
  // ProtocolError for a message whose pixels are not those of its tiles.
  void paste(int from, const PixelMessage& message);

  // Takes tiles that nobody has sent from an earlier picture; returns their number.
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
