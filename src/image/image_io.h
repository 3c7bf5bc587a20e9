// Reads and writes pictures as OpenEXR and PNG.
//
// Equal input gives equal bytes: files hold no time stamp and nothing of the machine.
//
// Values are display values (docs/decisions/0004-display-values.md). An EXR holds them as half floats, a PNG
// as round(255 v) with v clamped to [0, 1]. No transfer curve is applied in either direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "image/image.h"
#include "image/image_layers.h"

namespace pprt {

// Metadata in a picture's header, in this order.
//
// In an EXR a number becomes an int attribute, or a double attribute if it is a double or exceeds 32 bits.
// Names of OpenEXR's own attributes are refused. In a PNG each is a text; names have at most 79 printable
// ASCII characters.
using MetadataValue = std::variant<std::string, double, std::int64_t>;
using Metadata = std::vector<std::pair<std::string, MetadataValue>>;

// Sets every channel that is NaN or infinite to 0. Returns the number of pixels that had one.
std::size_t replace_non_finite(Image& image);

// What a picture is, which selects its compression (docs/decisions/0005-picture-encoding.md).
enum class PictureKind : std::uint8_t {
  kRendered,  // surfaces with smooth colours
  kHurried,   // the same, where time counts before size
  kDrawn      // a layer of lines, areas and numbers
};

// Return the bytes of a file. Values beyond the range of half (65504) are clamped to it. Channels are stored
// beside R, G and B, in 32 bits each.
//
// Throw std::runtime_error with the reason: an empty picture, a value that is not finite, a name that the
// format refuses. For a channel also: another size than the picture's, a NaN, a name that is taken.
std::string encode_exr(const Image& image, const Metadata& metadata = {},
                       const std::vector<Channel>& channels = {}, PictureKind kind = PictureKind::kRendered);
std::string encode_png(const Image& image, const Metadata& metadata = {},
                       PictureKind kind = PictureKind::kRendered);

// Returns the bytes of a JPEG for a screen, with colours at full resolution. `quality`: 1 to 100. Throws as
// encode_png().
std::string encode_jpeg(const Image& image, int quality);

inline constexpr std::uint64_t kAnyMemory = std::numeric_limits<std::uint64_t>::max();

// Return the picture in a file's bytes. Throw std::runtime_error with the reason. EXR: channels R, G, B of
// any pixel type, or Y alone; of several parts the first. PNG: any colour type and depth; transparency is
// composited over black.
//
// `max_memory`: bytes that decoding may take, judged by the size in the header before anything is decoded.
Image decode_exr(std::string_view bytes, std::uint64_t max_memory = kAnyMemory);
Image decode_png(std::string_view bytes, std::uint64_t max_memory = kAnyMemory);

// A picture's colours, whatever shines through them, and the alpha of each pixel.
struct TransparentImage {
  Image colors;
  std::vector<float> alpha;  // empty: 1 everywhere
};
TransparentImage decode_transparent_png(std::string_view bytes, std::uint64_t max_memory = kAnyMemory);

// Writes a picture in the format of its extension, .exr or .png, completely or not at all
// (image/atomic_file.h). Channels go into an EXR; a PNG ignores them. Returns the file's CRC-32. Throws
// std::runtime_error "cannot write 'PATH': REASON".
std::uint32_t write_image(const std::filesystem::path& path, const Image& image,
                          const Metadata& metadata = {}, const std::vector<Channel>& channels = {},
                          PictureKind kind = PictureKind::kRendered);

// Returns the picture in a JPEG, or in a PPM of 8 bits a channel (P6 or P3; bytes behind the picture are
// ignored). Throw as decode_png().
Image decode_jpeg(std::string_view bytes, std::uint64_t max_memory = kAnyMemory);
Image decode_ppm(std::string_view bytes, std::uint64_t max_memory = kAnyMemory);

// Returns the picture in the bytes of an EXR, a PNG, a JPEG or a PPM, told apart by the first ones. Throws as
// decode_png().
Image decode_image(std::string_view bytes, std::uint64_t max_memory = kAnyMemory);

// The same with the alpha of a PNG; other formats have none.
TransparentImage decode_transparent_image(std::string_view bytes, std::uint64_t max_memory = kAnyMemory);

// Reads such a file. Throws std::runtime_error "cannot read 'PATH': REASON".
Image read_image(const std::filesystem::path& path, std::uint64_t max_memory = kAnyMemory);

}  // namespace pprt
