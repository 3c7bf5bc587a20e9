#include <turbojpeg.h>

#include <memory>
#include <stdexcept>

#include "image/display_bytes.h"
#include "image/image_io.h"
#include "image/picture_checks.h"

namespace pprt {
namespace {

struct DestroyCompressor {
  void operator()(void* compressor) const { tjDestroy(compressor); }
};
struct FreeBytes {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

}  // namespace

std::string encode_jpeg(const Image& image, int quality) {
  require_encodable(image);
  const std::vector<std::uint8_t> pixels = display_bytes(image);
  const std::unique_ptr<void, DestroyCompressor> compressor(tjInitCompress());
  if (!compressor) throw std::runtime_error("libjpeg-turbo cannot be set up");
  unsigned char* allocated = nullptr;
  unsigned long size = 0;
  const int failed = tjCompress2(compressor.get(), pixels.data(), image.width, 0, image.height, TJPF_RGB,
                                 &allocated, &size, TJSAMP_444, quality, TJFLAG_FASTDCT);
  const std::unique_ptr<unsigned char, FreeBytes> bytes(allocated);
  if (failed != 0) throw std::runtime_error(tjGetErrorStr2(compressor.get()));
  return {reinterpret_cast<const char*>(bytes.get()), size};
}

}  // namespace pprt
