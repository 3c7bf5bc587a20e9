#include <turbojpeg.h>

#include <memory>
#include <stdexcept>
#include <vector>

#include "image/display_bytes.h"
#include "image/image_io.h"
#include "image/picture_checks.h"

namespace pprt {
namespace {

struct DestroyCompressor {
  void operator()(void* compressor) const { tjDestroy(compressor); }
};
using TurboJpeg = std::unique_ptr<void, DestroyCompressor>;
struct FreeBytes {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

}  // namespace

std::string encode_jpeg(const Image& image, int quality) {
  require_encodable(image);
  const std::vector<std::uint8_t> pixels = display_bytes(image);
  const TurboJpeg compressor(tjInitCompress());
  if (!compressor) throw std::runtime_error("libjpeg-turbo cannot be set up");
  unsigned char* allocated = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(compressor.get(), pixels.data(), image.width, 0, image.height, TJPF_RGB,
                                 &allocated, &size, TJSAMP_444, quality, TJFLAG_FASTDCT);
  const std::unique_ptr<unsigned char, FreeBytes> bytes(allocated);
  if (failed != 0) throw std::runtime_error(tjGetErrorStr2(compressor.get()));
  return {reinterpret_cast<const char*>(bytes.get()), size};
}

Image decode_jpeg(std::string_view bytes, std::uint64_t max_memory) {
  const TurboJpeg decoder(tjInitDecompress());
  if (!decoder) throw std::runtime_error("libjpeg-turbo cannot be set up");
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const auto require = [&](int failed) {
    if (failed != 0) throw std::runtime_error(tjGetErrorStr2(decoder.get()));
  };
  int width = 0, height = 0, subsampling = 0, colors = 0;
  require(tjDecompressHeader3(decoder.get(), data, bytes.size(), &width, &height, &subsampling, &colors));
  require_decodable_size(width, height, max_memory);
  Image image(width, height);
  std::vector<unsigned char> rgb(3 * image.pixels.size());
  require(tjDecompress2(decoder.get(), data, bytes.size(), rgb.data(), width, 0, height, TJPF_RGB,
                        TJFLAG_STOPONWARNING));
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = Color(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]) * (1 / 255.F);
  return image;
}

}  // namespace pprt
