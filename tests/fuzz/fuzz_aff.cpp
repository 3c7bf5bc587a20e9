// libFuzzer entry. Any bytes must be an InputError, or a scene whose indices are in range and that is finite
// at every time.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "aff_invariants.h"
#include "base/diagnostics.h"
#include "parser/aff_parser.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    pprt::AffOptions options;
    options.strict = (data[0] & 1) != 0;
    const pprt::SceneDescription scene = pprt::parse_aff(text, "fuzz.aff", options).scene;
    pprt::fuzz::require_indices_in_range(scene);
    pprt::fuzz::require_finite_at_all_times(scene);
  } catch (const pprt::InputError&) {
  }
  return 0;
}
