// libFuzzer's entry point for the NFF reader: whatever the bytes, a scene or an InputError.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/diagnostics.h"
#include "parser/nff_parser.h"

namespace {

void read(std::string_view text, const pprt::NffOptions& options) {
  try {
    pprt::parse_nff(text, "fuzz.nff", options);
  } catch (const pprt::InputError&) {
    // The text is no scene, and that has been said: as it should be.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  pprt::NffOptions options;
  read(text, options);
  options.strict = true;
  read(text, options);
  return 0;
}
