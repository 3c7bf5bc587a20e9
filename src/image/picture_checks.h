// Checks of a picture before encoding and while decoding. Private to src/image.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace pprt {

// Largest picture that is decoded: 16384 x 16384, 3 GiB. It keeps a damaged or hostile header from exhausting
// memory.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;

// Throws std::runtime_error when the picture has no pixels, a wrong number of pixels for its size, or a value
// that is not finite.
void require_encodable(const Image& image);

// Throws std::runtime_error unless 1 <= width * height <= kMaxPixels, and decoding takes no more memory than
// that, bytes. A file of some kilobytes can hold a picture of gigabytes.
void require_decodable_size(std::int64_t width, std::int64_t height, std::uint64_t max_memory);

}  // namespace pprt
