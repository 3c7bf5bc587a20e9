#include "pipeline/visibility/pixel_shares.h"

namespace pprt {

NearestInPixel::NearestInPixel(int points) : vectors_(static_cast<std::size_t>(points / kPoints)) {
  for (std::size_t i = 0; i < vectors_; ++i) nearest_[i] = PerPoint{}, numbers_[i] = Numbers{};
}

PPRT_CLONED_FOR_WIDE_REGISTERS void NearestInPixel::count(std::span<int> counts) const {
  for (std::size_t number = 0; number < counts.size(); ++number) {
    Numbers found{};
    for (std::size_t i = 0; i < vectors_; ++i) found -= numbers_[i] == static_cast<std::int32_t>(number);
    counts[number] =
        ((found[0] + found[4]) + (found[1] + found[5])) + ((found[2] + found[6]) + (found[3] + found[7]));
  }
}

}  // namespace pprt
