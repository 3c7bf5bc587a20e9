#include "convert/convert.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "base/counted.h"
#include "base/diagnostics.h"
#include "base/file_table.h"
#include "cli/scenes/scene_source.h"
#include "convert/losses.h"
#include "convert/mesh/mesh_writer.h"
#include "convert/model_scene.h"
#include "convert/names/extension.h"
#include "convert/names/picture_names.h"
#include "convert/pov/pov_material.h"
#include "convert/pov/pov_writer.h"
#include "convert/surfaces/tessellate.h"
#include "image/atomic_file.h"
#include "image/image_io.h"
#include "scene/animation/resting_nodes.h"
#include "scene/writers/aff_writer.h"
#include "scene/writers/nff_writer.h"
#include "spd/spd.h"

namespace pprt {
namespace {

enum class InputFormat { kScene, kMesh };
enum class OutputFormat { kNff, kAff, kPov, kMesh };

InputFormat input_format(const std::string& input) {
  if (is_spd_name(input) || input == "-") return InputFormat::kScene;
  const std::string extension = extension_of(input);
  if (extension == ".nff" || extension == ".aff") return InputFormat::kScene;
  if (is_model_name(input)) return InputFormat::kMesh;
  throw UsageError(
      fmt::format("cannot tell the format of input '{}': it must be FILE.nff, FILE.aff, - (NFF on standard "
                  "input), spd:NAME[:SIZE] or a mesh such as FILE.obj{}",
                  input, hint_at_meant(input)));
}

OutputFormat output_format(const std::string& output) {
  const std::string extension = extension_of(output);
  if (!is_spd_name(output)) {
    if (output == "-" || extension == ".nff") return OutputFormat::kNff;
    if (extension == ".aff") return OutputFormat::kAff;
    if (extension == ".pov") return OutputFormat::kPov;
    const std::vector<std::string>& meshes = mesh_output_extensions();
    if (std::find(meshes.begin(), meshes.end(), extension) != meshes.end()) return OutputFormat::kMesh;
  }
  throw UsageError(fmt::format(
      "cannot tell the format of output '{}': it must be FILE.nff, - (NFF on standard output) or FILE with "
      "one of .aff .pov {}",
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
  if (count > 0)
    say(scene, counted(count, "object without extent left out", "objects without extent left out"));
}

// Returns the scene as the output can hold it: with its movement, or at one time.
SceneDescription at_time_asked(SceneDescription scene, const ConvertOptions& options, OutputFormat to) {
  if (!moves(scene)) {
    if (options.at) throw UsageError("--at: nothing moves in " + scene.name);
    return scene;
  }
  if (!options.at && to == OutputFormat::kAff) return scene;
  const double time = options.at.value_or(start_time(scene.movement));
  if (options.at || to != OutputFormat::kMesh || !keeps_movement(extension_of(options.output)))
    return still_at(std::move(scene), time);
  if (const std::size_t count = scene.moving_triangles.size(); count > 0)
    say(scene, fmt::format("{} of {} seconds",
                           counted(count, "triangle that changes its shape keeps that",
                                   "triangles that change their shape keep that"),
                           time));
  return with_still_triangles(std::move(scene), time);
}

ParsedScene read(const ConvertOptions& options, InputFormat format) {
  NffOptions reading{.strict = options.strict};
  if (options.memory) reading.max_memory = *options.memory;
  if (format == InputFormat::kScene) {
    ParsedScene parsed = load_scene(options.input, reading);
    std::cerr << parsed.warnings;
    return parsed;
  }
  ParsedScene parsed = load_model(options.input, {.limits = {.seconds = options.mesh_seconds,
                                                             .memory_bytes = reading.max_memory,
                                                             .animation = options.animation},
                                                  .up = options.up})
                           .parsed;
  std::cerr << parsed.warnings;
  return parsed;
}

// Files that were read: the one named, and others.
struct Inputs {
  std::string named;
  std::vector<std::string> all;
};
using Outputs = std::vector<std::filesystem::path>;  // first the one named

// Throws UsageError when a file that will be written has been read, or is another one that will be written.
// The file named may be converted in place.
void require_distinct(const Inputs& inputs, const Outputs& outputs) {
  FileTable table;
  for (const std::string& input : inputs.all) {
    if (input != inputs.named) table.add_input({"the input", input});
  }
  table.add_output({"the output", outputs.front()});
  table.add_input({"the input", inputs.named});
  for (std::size_t i = 1; i < outputs.size(); ++i) table.add_output({"the output", outputs[i]});
}

void write_pov_and_tell(const SceneDescription& scene, std::ostream& out, const std::string& stem) {
  const PovLosses losses = write_pov(scene, out, stem);
  if (losses.one_sided > 0) {
    say(scene,
        counted(losses.one_sided, "sphere or cone of which only the inside is seen: POV-Ray shows both sides",
                "spheres or cones of which only the inside is seen: POV-Ray shows both sides"));
  }
  if (losses.lost_highlights > 0) {
    say(scene, counted(losses.lost_highlights, "material with a coloured highlight that becomes white",
                       "materials with a coloured highlight that becomes white"));
  }
  if (losses.lost_ambient > 0) {
    say(scene,
        counted(
            losses.lost_ambient,
            "material with a texture lacks ambient light in a colour that it does not reflect diffusely",
            "materials with a texture lack ambient light in a colour that they do not reflect diffusely"));
  }
  say_degenerate(scene, losses.degenerate);
}

// Tells what is lost and returns the rest.
SceneDescription told(PlainScene plain) {
  for (const std::string& loss : plain.losses) say(plain.scene, loss);
  return std::move(plain.scene);
}

// Leaves no spheres and cones that a node stretches.
SceneDescription without_stretched(SceneDescription scene, const ConvertOptions& options) {
  if (scene.nodes.empty()) return scene;
  const auto count = static_cast<std::size_t>(
      std::count_if(scene.nodes.begin(), scene.nodes.end(), [](NodeIndex node) { return node != 0; }));
  say(scene, counted(count, "stretched sphere or cone becomes triangles",
                     "stretched spheres or cones become triangles"));
  return with_stretched_tessellated(scene, fineness(options));
}

// Returns a file and others in its directory.
Outputs with_files_beside(const std::filesystem::path& path, const std::vector<std::string>& names) {
  Outputs outputs = {path};
  for (const std::string& name : names) outputs.push_back(path.parent_path() / name);
  return outputs;
}

void write_mesh_files(SceneDescription scene, const ConvertOptions& options, const Inputs& inputs) {
  check_triangle_count(scene, fineness(options));
  const std::filesystem::path path = options.output;
  const std::string extension = extension_of(path);
  scene = told(for_meshes(std::move(scene), keeps_textures(extension)));
  if (!keeps_movement(extension)) scene = without_stretched(std::move(scene), options);
  const WrittenMesh mesh = write_mesh(scene, extension, path.stem().string(), fineness(options));
  std::vector<std::string> beside;
  for (const MeshFile& file : mesh.files) beside.push_back(file.name);
  beside.pop_back();  // the file named, perhaps with its extension in capitals
  const Outputs outputs = with_files_beside(path, beside);
  require_distinct(inputs, outputs);
  for (std::size_t i = 0; i < beside.size(); ++i) write_whole_file(outputs[i + 1], mesh.files[i].bytes);
  write_whole_file(path, mesh.files.back().bytes);
  say_degenerate(scene, mesh.degenerate);
}

void write_nff_file(SceneDescription scene, const ConvertOptions& options, const Inputs& inputs) {
  scene = without_stretched(told(for_nff(std::move(scene))), options);
  if (options.output == "-") {
    write_nff(scene, std::cout);
    std::cout.flush();
    if (!std::cout) throw std::runtime_error("cannot write to standard output");
    return;
  }
  require_distinct(inputs, {options.output});
  write_whole_file(options.output, [&](std::ostream& out) { write_nff(scene, out); });
}

// Each writes the scene last, after the pictures that it refers to.
void write_aff_files(const SceneDescription& scene, const ConvertOptions& options, const Inputs& inputs) {
  const std::filesystem::path path = options.output;
  const std::vector<std::string> pictures = picture_names(scene, path.stem().string());
  require_distinct(inputs, with_files_beside(path, pictures));
  for (TextureIndex i = 0; i < scene.textures.size(); ++i)
    write_image(path.parent_path() / pictures[i], picture_of(scene, {.name = {}, .texture = i}));
  write_whole_file(path, [&](std::ostream& out) { write_aff(scene, out, pictures); });
}

void write_pov_files(const SceneDescription& scene, const ConvertOptions& options, const Inputs& inputs) {
  const std::filesystem::path path = options.output;
  const std::string stem = path.stem().string();
  const std::vector<PovPicture> pictures = pov_pictures(scene, stem).files;
  std::vector<std::string> names;
  for (const PovPicture& picture : pictures) names.push_back(picture.name);
  require_distinct(inputs, with_files_beside(path, names));
  for (const PovPicture& picture : pictures)
    write_image(path.parent_path() / picture.name, picture_of(scene, picture));
  write_whole_file(path, [&](std::ostream& out) { write_pov_and_tell(scene, out, stem); });
}

}  // namespace

void convert(const ConvertOptions& options) {
  const InputFormat from = input_format(options.input);
  const OutputFormat to = output_format(options.output);
  ParsedScene input = read(options, from);
  const Inputs inputs{options.input, std::move(input.files)};
  SceneDescription scene = at_time_asked(std::move(input.scene), options, to);
  if (to == OutputFormat::kMesh) return write_mesh_files(std::move(scene), options, inputs);
  if (const std::optional<std::string> added = complete_view(scene, options.up)) say(scene, *added);
  if (options.tessellate || options.chord_error) scene = tessellated(scene, fineness(options));
  if (to == OutputFormat::kAff) return write_aff_files(scene, options, inputs);
  if (to == OutputFormat::kPov) return write_pov_files(scene, options, inputs);
  write_nff_file(std::move(scene), options, inputs);
}

}  // namespace pprt
