#include "convert/convert.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "base/diagnostics.h"
#include "cli/scene_source.h"
#include "convert/mesh_reader.h"
#include "convert/mesh_writer.h"
#include "convert/pov_writer.h"
#include "convert/tessellate.h"
#include "image/atomic_file.h"
#include "scene/nff_writer.h"
#include "spd/spd.h"

namespace pprt {
namespace {

enum class InputFormat { kScene, kMesh };
enum class OutputFormat { kNff, kPov, kMesh };

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

InputFormat input_format(const std::string& input) {
  if (is_spd_name(input) || input == "-") return InputFormat::kScene;
  const std::string extension = extension_of(input);
  if (extension == ".nff") return InputFormat::kScene;
  if (is_mesh_extension(extension)) return InputFormat::kMesh;
  throw UsageError(
      fmt::format("cannot tell the format of input '{}': it must be FILE.nff, - (NFF on standard input), "
                  "spd:NAME[:SIZE] or a mesh such as FILE.obj{}",
                  input, hint_at_meant(input)));
}

OutputFormat output_format(const std::string& output) {
  const std::string extension = extension_of(output);
  if (!is_spd_name(output)) {
    if (output == "-" || extension == ".nff") return OutputFormat::kNff;
    if (extension == ".pov") return OutputFormat::kPov;
    const std::vector<std::string>& meshes = mesh_output_extensions();
    if (std::find(meshes.begin(), meshes.end(), extension) != meshes.end()) return OutputFormat::kMesh;
  }
  throw UsageError(fmt::format(
      "cannot tell the format of output '{}': it must be FILE.nff, - (NFF on standard output) or FILE with "
      "one of .pov {}",
      output, fmt::join(mesh_output_extensions(), " ")));
}

Fineness fineness(const ConvertOptions& options) {
  Fineness result;
  result.divisions = options.tessellate.value_or(result.divisions);
  result.chord_error = options.chord_error;
  return result;
}

void say(const SceneDescription& scene, const std::string& what) {
  std::cerr << scene.name << ": " << what << '\n';
}

void say_degenerate(const SceneDescription& scene, std::size_t count) {
  if (count > 0) say(scene, fmt::format("{} objects without extent left out", count));
}

// Adds a view, which mesh files often lack and a scene to be rendered needs.
void complete_view(SceneDescription& scene, UpAxis up) {
  if (scene.view || scene.primitive_count() == 0) return;
  scene.view = fitted_view(scene, up);
  const bool y = up == UpAxis::kY;
  say(scene, fmt::format("no camera: one that shows everything is added, with {} up (--up {} for the other)",
                         y ? 'y' : 'z', y ? 'z' : 'y'));
}

void complete_lights(SceneDescription& scene) {
  if (!scene.lights.empty()) return;
  scene.lights.push_back(default_light(scene, *scene.view));
  say(scene, "no lights: one behind the viewer's left shoulder is added");
}

SceneDescription read(const ConvertOptions& options, InputFormat format) {
  if (format == InputFormat::kScene) {
    ParsedScene parsed = load_scene(options.input, {.strict = options.strict});
    std::cerr << parsed.warnings;
    return std::move(parsed.scene);
  }
  require_file(options.input);
  ReadMesh mesh = read_mesh(options.input);
  for (const std::string& note : mesh.notes) say(mesh.scene, note);
  complete_view(mesh.scene, options.up);
  complete_lights(mesh.scene);
  return std::move(mesh.scene);
}

void write_pov_and_tell(const SceneDescription& scene, std::ostream& out) {
  const PovLosses losses = write_pov(scene, out);
  if (losses.one_sided > 0) {
    say(scene, fmt::format("{} spheres or cones of which only the inside is seen: POV-Ray shows both sides",
                           losses.one_sided));
  }
  say_degenerate(scene, losses.degenerate);
}

void write_mesh_files(const SceneDescription& scene, const ConvertOptions& options) {
  const std::filesystem::path path = options.output;
  const WrittenMesh mesh =
      write_mesh(scene, extension_of(options.output), path.stem().string(), fineness(options));
  for (const MeshFile& file : mesh.files) {
    const bool named = &file == &mesh.files.back();  // perhaps with its extension in capitals
    write_whole_file(named ? path : path.parent_path() / file.name, file.bytes);
  }
  say_degenerate(scene, mesh.degenerate);
}

void write_text(const SceneDescription& scene, const ConvertOptions& options, OutputFormat format) {
  if (options.output == "-") {
    write_nff(scene, std::cout);
    std::cout.flush();
    if (!std::cout) throw std::runtime_error("cannot write to standard output");
    return;
  }
  write_whole_file(options.output, [&](std::ostream& out) {
    if (format == OutputFormat::kNff) return write_nff(scene, out);
    write_pov_and_tell(scene, out);
  });
}

}  // namespace

void convert(const ConvertOptions& options) {
  const InputFormat from = input_format(options.input);
  const OutputFormat to = output_format(options.output);
  SceneDescription scene = read(options, from);
  if (to == OutputFormat::kMesh) return write_mesh_files(scene, options);
  complete_view(scene, options.up);
  if (options.tessellate || options.chord_error) scene = tessellated(scene, fineness(options));
  write_text(scene, options, to);
}

}  // namespace pprt
