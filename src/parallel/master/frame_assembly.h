// A frame on rank 0 while the ranks' pixels come in.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/master/mosaic.h"
#include "parallel/protocol/messages.h"

namespace pprt {

class FrameAssembly {
 public:
  // Expects nothing of the ranks that the order calls lost.
  FrameAssembly(const FrameOrder& order, const TileGrid& grid, int ranks);

  // Takes in one rank's pixels, or a part of them. Throws ProtocolError when they come a second time.
  void add(int from, const PixelMessage& message);

  bool awaits(int rank) const { return has_come_[static_cast<std::size_t>(rank)] == 0; }
  bool is_whole() const { return missing_ == 0; }
  const FrameOrder& order() const { return order_; }
  std::span<const RankReport> reports() const { return reports_; }  // empty ones of late ranks
  std::vector<std::int32_t> late_ranks() const;                     // whose pixels have not come: ascending

  // Moved out when the frame is delivered.
  Mosaic picture;
  std::vector<Sample> samples;
  std::vector<std::vector<TileReport>> tiles;  // per rank
  std::vector<TransferChoice> transfers;       // of all ranks, as they came

 private:
  FrameOrder order_;
  std::vector<RankReport> reports_;
  std::vector<std::uint8_t> has_come_;  // per rank: all its pixels
  int missing_;                         // ranks whose pixels have not come
};

}  // namespace pprt
