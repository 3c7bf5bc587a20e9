#include "parallel/master/frame_assembly.h"

#include <cstddef>

namespace pprt {

FrameAssembly::FrameAssembly(const FrameOrder& order, const TileGrid& grid, int ranks)
    : picture(grid),
      tiles(static_cast<std::size_t>(ranks)),
      order_(order),
      reports_(static_cast<std::size_t>(ranks)),
      has_come_(static_cast<std::size_t>(ranks), 0),
      missing_(ranks - static_cast<int>(order.lost.size())) {
  for (const int rank : order.lost) has_come_[static_cast<std::size_t>(rank)] = 1;
}

void FrameAssembly::add(int from, const PixelMessage& message) {
  const auto rank = static_cast<std::size_t>(from);
  if (has_come_[rank] != 0) throw ProtocolError("pixels came twice");
  picture.paste(from, message);
  tiles[rank].insert(tiles[rank].end(), message.tiles.begin(), message.tiles.end());
  if (!message.is_last) return;
  has_come_[rank] = 1;
  reports_[rank] = message.report;
  samples.insert(samples.end(), message.samples.begin(), message.samples.end());
  --missing_;
}

std::vector<std::int32_t> FrameAssembly::late_ranks() const {
  std::vector<std::int32_t> ranks;
  for (std::size_t rank = 0; rank < has_come_.size(); ++rank) {
    if (has_come_[rank] == 0) ranks.push_back(static_cast<std::int32_t>(rank));
  }
  return ranks;
}

}  // namespace pprt
