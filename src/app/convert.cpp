#include "app/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <iostream>
#include <stdexcept>

#include "app/scene_source.h"
#include "base/diagnostics.h"
#include "convert/pov_writer.h"
#include "image/whole_file.h"
#include "scene/nff_writer.h"
#include "spd/spd.h"

namespace pprt {
namespace {

enum class Format { kNff, kPov };

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void check_input(const std::string& input) {
  if (is_spd_name(input) || input == "-" || extension_of(input) == ".nff") return;
  throw UsageError("cannot tell the format of input '" + input +
                   "': it must be FILE.nff, - (NFF on standard input) or spd:NAME[:SIZE]");
}

Format output_format(const std::string& output) {
  const std::string extension = extension_of(output);
  if (!is_spd_name(output)) {
    if (output == "-" || extension == ".nff") return Format::kNff;
    if (extension == ".pov") return Format::kPov;
  }
  throw UsageError("cannot tell the format of output '" + output +
                   "': it must be FILE.nff, FILE.pov or - (NFF on standard output)");
}

void say(const SceneDescription& scene, const std::string& what) {
  std::cerr << scene.name << ": " << what << '\n';
}

void write_pov_and_tell(const SceneDescription& scene, std::ostream& out) {
  const PovLosses losses = write_pov(scene, out);
  if (losses.one_sided > 0) {
    say(scene, fmt::format("{} spheres or cones of which only the inside is seen: POV-Ray shows both sides",
                           losses.one_sided));
  }
  if (losses.degenerate > 0) say(scene, fmt::format("{} objects without extent left out", losses.degenerate));
}

void write_to_standard_output(const SceneDescription& scene) {
  write_nff(scene, std::cout);
  std::cout.flush();
  if (!std::cout) throw std::runtime_error("cannot write to standard output");
}

}  // namespace

void convert(const ConvertOptions& options) {
  check_input(options.input);
  const Format format = output_format(options.output);
  const ParsedScene parsed = load_scene(options.input, {.strict = options.strict});
  std::cerr << parsed.warnings;
  if (options.output == "-") return write_to_standard_output(parsed.scene);
  write_whole_file(options.output, [&](std::ostream& out) {
    if (format == Format::kNff) return write_nff(parsed.scene, out);
    write_pov_and_tell(parsed.scene, out);
  });
}

}  // namespace pprt
