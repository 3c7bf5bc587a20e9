// Pictures to and from files: OpenEXR and PNG.
//
// Equal pictures and facts give equal bytes: no time stamps, nothing of the machine.
//
// Values are display values (docs/decisions/0004-display-values.md): an EXR holds them as they are, as half
// floats; a PNG holds round(255 v), v clamped to [0, 1], and no transfer curve is applied in either
// direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "image/image.h"
#include "image/image_layers.h"

namespace pprt {

// Facts that go along in a picture's header, in this order. In an EXR a number becomes an int attribute, a
// double one when it does not fit 32 bits or is a double; a name that OpenEXR gives a meaning of its own is
// refused. In a PNG each is a text; names have at most 79 printable ASCII characters.
using Fact = std::variant<std::string, double, std::int64_t>;
using Facts = std::vector<std::pair<std::string, Fact>>;

// The gate: sets every channel that is NaN or infinite to 0 and returns how many pixels had one.
std::size_t replace_non_finite(Image& image);

// What a picture shows: surfaces, in which colours run; or what layers do, lines, areas and numbers as
// colours, whose patterns come again. A PNG is packed accordingly (docs/decisions/0005-picture-encoding.md).
enum class PictureKind : std::uint8_t { kRendered, kDrawn };

// The file's bytes. Throw std::runtime_error with the reason when the picture is empty, has a value that is
// not finite (it should have passed the gate), or a fact has a name that the format refuses. Values beyond
// the range of half (65504) are clamped to it. Channels stand beside R, G and B, in 32 bits each;
// std::runtime_error when one has not the picture's size, a NaN, or a name that is taken.
std::string encode_exr(const Image& image, const Facts& facts = {},
                       const std::vector<Channel>& channels = {});
std::string encode_png(const Image& image, const Facts& facts = {},
                       PictureKind kind = PictureKind::kRendered);

// The picture in a file's bytes. Throw std::runtime_error with the reason.
// EXR: channels R, G, B of any pixel type, or Y alone; the first part of several.
// PNG: any colour type and depth; what is transparent lets black through.
Image decode_exr(std::string_view bytes);
Image decode_png(std::string_view bytes);

// Writes the whole file or nothing (see image/whole_file.h); the format is the extension's, .exr or .png.
// Throws std::runtime_error "cannot write 'PATH': REASON". Channels are for an EXR; a PNG has no room for
// them.
void write_image(const std::filesystem::path& path, const Image& image, const Facts& facts = {},
                 const std::vector<Channel>& channels = {}, PictureKind kind = PictureKind::kRendered);

// Reads an EXR or a PNG, told apart by their first bytes. Throws std::runtime_error "cannot read 'PATH':
// REASON".
Image read_image(const std::filesystem::path& path);

}  // namespace pprt
