#include "image/checksum.h"

#include <zlib.h>

#include <exception>
#include <system_error>

#include "image/atomic_file.h"

namespace pprt {

std::uint32_t crc32_of(std::string_view bytes) {
  const auto* first = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(0, first, bytes.size()));
}

std::optional<std::uint32_t> crc32_of_file(const std::filesystem::path& path) try {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return std::nullopt;  // a pipe would keep us waiting
  return crc32_of(read_whole_file(path));
} catch (const std::exception&) {
  return std::nullopt;
}

}  // namespace pprt
