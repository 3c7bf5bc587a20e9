#include "app/convert.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "app/scene_source.h"
#include "base/diagnostics.h"
#include "image/whole_file.h"
#include "scene/nff_writer.h"
#include "spd/spd.h"

namespace pprt {
namespace {

bool is_nff_name(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return path == "-" || extension == ".nff";
}

void check_formats(const ConvertOptions& options) {
  if (!is_spd_name(options.input) && !is_nff_name(options.input)) {
    throw UsageError("cannot tell the format of input '" + options.input +
                     "': it must be FILE.nff, - (NFF on standard input) or spd:NAME[:SIZE]");
  }
  if (is_spd_name(options.output) || !is_nff_name(options.output)) {
    throw UsageError("cannot tell the format of output '" + options.output +
                     "': it must be FILE.nff or - (NFF on standard output)");
  }
}

void write_to_standard_output(const SceneDescription& scene) {
  write_nff(scene, std::cout);
  std::cout.flush();
  if (!std::cout) throw std::runtime_error("cannot write to standard output");
}

}  // namespace

void convert(const ConvertOptions& options) {
  check_formats(options);
  const ParsedScene parsed = load_scene(options.input, {.strict = options.strict});
  std::cerr << parsed.warnings;
  if (options.output == "-") return write_to_standard_output(parsed.scene);
  std::ostringstream text;
  write_nff(parsed.scene, text);
  write_whole_file(options.output, std::move(text).str());
}

}  // namespace pprt
