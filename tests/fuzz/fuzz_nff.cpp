// libFuzzer entry. Any bytes must be an InputError or a scene. A scene must read back unchanged from the
// canonical text that ranks receive.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "parser/nff_parser.h"
#include "scene/writers/nff_writer.h"

namespace {

std::optional<pprt::SceneDescription> read(std::string_view text, const pprt::NffOptions& options) {
  try {
    return pprt::parse_nff(text, "fuzz.nff", options).scene;
  } catch (const pprt::InputError&) {
    return std::nullopt;  // no scene, and that has been said: as it should be
  }
}

std::string canonical(const pprt::SceneDescription& scene) {
  std::ostringstream text;
  pprt::write_nff(scene, text);
  return std::move(text).str();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  pprt::NffOptions options;
  const auto scene = read(text, options);
  if (scene) {
    const std::string sent = canonical(*scene);
    const auto received = sent.empty() ? scene : read(sent, options);
    if (!received || canonical(*received) != sent) std::abort();
  }
  options.strict = true;
  if (read(text, options) && !scene) std::abort();  // strict reading accepts no more
  return 0;
}
