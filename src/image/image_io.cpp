#include "image/image_io.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "image/atomic_file.h"
#include "image/checksum.h"

namespace pprt {
namespace {

constexpr std::string_view kExrMagic = "\x76\x2f\x31\x01";
constexpr std::string_view kPngMagic = "\x89PNG\r\n\x1a\n";

std::string encode(const std::filesystem::path& path, const Image& image, const Metadata& metadata,
                   const std::vector<Channel>& channels, PictureKind kind) {
  if (path.extension() == ".exr") return encode_exr(image, metadata, channels, kind);
  if (path.extension() == ".png") return encode_png(image, metadata, kind);
  throw std::runtime_error("the name ends neither in .exr nor in .png");
}

}  // namespace

std::size_t replace_non_finite(Image& image) {
  std::size_t replaced = 0;
  for (Color& pixel : image.pixels) {
    bool bad = false;
    for (int c = 0; c < 3; ++c) {
      if (std::isfinite(pixel[c])) continue;
      pixel[c] = 0;
      bad = true;
    }
    replaced += bad;
  }
  return replaced;
}

std::uint32_t write_image(const std::filesystem::path& path, const Image& image, const Metadata& metadata,
                          const std::vector<Channel>& channels, PictureKind kind) {
  std::string bytes;
  try {
    bytes = encode(path, image, metadata, channels, kind);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("cannot write '{}': {}", path.string(), e.what()));
  }
  write_whole_file(path, bytes);
  return crc32_of(bytes);
}

Image decode_image(std::string_view bytes, std::uint64_t max_memory) {
  if (bytes.starts_with(kExrMagic)) return decode_exr(bytes, max_memory);
  if (bytes.starts_with(kPngMagic)) return decode_png(bytes, max_memory);
  if (bytes.starts_with("\xff\xd8")) return decode_jpeg(bytes, max_memory);
  if (bytes.starts_with("P6") || bytes.starts_with("P3")) return decode_ppm(bytes, max_memory);
  throw std::runtime_error(bytes.empty() ? "the file is empty" : "it is no OpenEXR, PNG, JPEG or PPM file");
}

TransparentImage decode_transparent_image(std::string_view bytes, std::uint64_t max_memory) {
  if (bytes.starts_with(kPngMagic)) return decode_transparent_png(bytes, max_memory);
  return {decode_image(bytes, max_memory), {}};
}

Image read_image(const std::filesystem::path& path, std::uint64_t max_memory) {
  const std::string bytes = read_whole_file(path);
  try {
    return decode_image(bytes, max_memory);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("cannot read '{}': {}", path.string(), e.what()));
  }
}

}  // namespace pprt
