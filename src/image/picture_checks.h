// What must hold of a picture before it is encoded and while it is decoded. Private to src/image.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace pprt {

// 16384 x 16384: a damaged or hostile header must not take the memory (3 GiB at this size).
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

// Throws std::runtime_error when the picture has no pixels, not the number of pixels that its size says, or a
// channel that is NaN or infinite.
void require_encodable(const Image& image);

// Throws std::runtime_error unless 1 <= width * height <= kMaxPixels.
void require_decodable_size(std::int64_t width, std::int64_t height);

}  // namespace pprt
