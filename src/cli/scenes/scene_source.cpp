#include "cli/scenes/scene_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/diagnostics.h"
#include "base/nearest_word.h"
#include "base/printable.h"
#include "cli/scenes/texture_files.h"
#include "parser/aff_parser.h"
#include "parser/text/reading_memory.h"
#include "parser/text/text_input.h"
#include "scene/animation/object_motion.h"
#include "scene/animation/resting_nodes.h"
#include "spd/spd.h"

namespace pprt {
namespace {

// Returns the files with the same extension in the directory of the one asked for.
std::vector<std::string> files_beside(const std::filesystem::path& path) {
  std::vector<std::string> names;
  const std::filesystem::path directory = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code none;  // without such a directory there is nothing to name
  for (const auto& entry : std::filesystem::directory_iterator(directory, none)) {
    if (entry.path().extension() == path.extension()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  return std::string(nearest_word(word, std::vector<std::string_view>(candidates.begin(), candidates.end())));
}

// Returns the name that was probably meant by that of a missing file; empty when nothing is close.
std::string meant_by(const std::string& name) {
  const std::filesystem::path path(name);
  if (const std::string file = nearest(path.filename().string(), files_beside(path)); !file.empty()) {
    return (path.parent_path() / file).string();
  }
  // The name may end in a size: "teapot:5".
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  const bool sized = digits > 1 && digits < name.size() && name[digits - 1] == ':';
  const std::string word = name.substr(0, sized ? digits - 1 : name.size());
  for (const std::string& tried : {word, "spd:" + word}) {
    if (const std::string scene = nearest(tried, generated_scenes()); !scene.empty()) {
      return scene + name.substr(word.size());
    }
  }
  return {};
}

bool is_aff_name(const std::string& name) {
  return std::filesystem::path(name).extension() == ".aff";
}

ParsedScene load_aff(const std::string& path, const NffOptions& options) {
  ParsedScene parsed = read_aff(path, {.strict = options.strict, .max_memory = options.max_memory});
  try {
    read_textures(parsed, std::filesystem::path(path).parent_path(), options.max_memory);
  } catch (const InputError& e) {
    throw InputError(parsed.warnings + e.what());
  }
  parsed.scene = without_resting_nodes(std::move(parsed.scene));
  return parsed;
}

// Returns a problem with a scene that a script names, reported at the place in the script that names it.
std::string at_name_in_script(const Animation& script, const std::string& script_path, SourceLocation place,
                              std::string problem) {
  constexpr std::string_view kError = ": error: ";
  if (const std::size_t at = problem.find(kError); at != std::string::npos) {
    problem.replace(at, kError.size(), ": ");  // the script's error now
  }
  Diagnostics diagnostics;
  diagnostics.error(place, std::move(problem));
  std::string report =
      report_of(diagnostics, script.name, read_text(script_path, std::numeric_limits<std::uint32_t>::max()));
  report.pop_back();  // the last line end
  return report;
}

// Returns what a script calls a file or a generated scene, for load_scene().
std::string named_in_script(const std::string& name, const std::string& script_path) {
  return is_spd_name(name) ? name : (std::filesystem::path(script_path).parent_path() / name).string();
}

}  // namespace

std::string hint_at_meant(const std::string& name) {
  const std::string meant = meant_by(name);
  return meant.empty() ? "" : "; did you mean '" + printable(meant) + "'?";
}

void require_file(const std::string& path) {
  std::error_code unknown;  // then reading will tell
  if (std::filesystem::exists(path, unknown) || unknown) return;
  throw InputError("cannot read '" + printable(path) + "': No such file or directory" + hint_at_meant(path));
}

std::vector<std::string> generated_scenes() {
  std::vector<std::string> names;
  for (const SpdDatabase& database : spd_databases()) names.push_back("spd:" + std::string(database.name));
  return names;
}

bool is_script_name(const std::string& name) {
  return std::filesystem::path(name).extension() == ".anim";
}

std::string scene_of_script(const Animation& script, const std::string& script_path) {
  if (!script.scene) {
    throw UsageError("the script " + script_path +
                     " names no scene: give one before it, or add 'scene \"...\"' to it");
  }
  return named_in_script(*script.scene, script_path);
}

ParsedScene load_scene_of_script(const Animation& script, const std::string& script_path,
                                 const NffOptions& options, const OtherReader& others) {
  const std::string name = scene_of_script(script, script_path);
  std::string text;
  try {
    if (is_spd_name(name)) return {.scene = make_spd_scene(name)};
    require_file(name);
    if (std::optional<ParsedScene> other = others ? others(name) : std::nullopt) return std::move(*other);
    if (is_aff_name(name)) return load_aff(name, options);
    text = read_text(name, options.max_bytes);
  } catch (const InputError& e) {
    throw InputError(at_name_in_script(script, script_path, script.scene_location, e.what()));
  }
  ParsedScene parsed = parse_nff(text, printable(name), options);
  parsed.files.push_back(name);
  return parsed;
}

void add_objects(ParsedScene& parsed, const Animation& script, const std::string& script_path,
                 const FrameTimes& times, const NffOptions& options, const OtherReader& others) {
  constexpr std::size_t kMostTurns = 5'000'000;  // an object that turns takes a key a frame
  SceneDescription& scene = parsed.scene;
  std::size_t turns = 0;
  const auto refuse = [&](const ObjectMotion& object, const std::string& problem) {
    throw InputError(at_name_in_script(script, script_path, object.location, problem));
  };
  for (const ObjectMotion& object : script.objects) {
    turns += static_cast<std::size_t>(times.frames);
    if (turns > kMostTurns)
      refuse(object,
             fmt::format("too many objects for so many frames: objects times frames, here {} times {}, "
                         "may be {} at most",
                         script.objects.size(), times.frames, kMostTurns));
    const std::vector<SceneNode>& nodes = scene.movement.nodes;
    const bool is_known = std::any_of(nodes.begin(), nodes.end(),
                                      [&](const SceneNode& node) { return node.track == object.name; });
    if (!is_known) {
      try {
        NffOptions left = options;
        left.max_memory -= std::min(left.max_memory, memory_of(scene));
        const std::string name = named_in_script(object.name, script_path);
        std::optional<ParsedScene> read = others ? others(name) : std::nullopt;
        ParsedScene other = read ? std::move(*read) : load_scene(name, left);
        parsed.warnings += other.warnings;
        parsed.files.insert(parsed.files.end(), other.files.begin(), other.files.end());
        add_moving(scene, other.scene, object.name);
      } catch (const InputError& e) {
        refuse(object, e.what());
      }
    }
    if (!object.keys.empty()) scene.movement.tracks[object.name] = track_of(object, times);
  }
}

ParsedScene load_scene(const std::string& name, const NffOptions& options) {
  if (is_spd_name(name)) return {.scene = make_spd_scene(name)};
  if (name != "-") require_file(name);
  if (is_aff_name(name)) return load_aff(name, options);
  return read_nff(name, options);
}

}  // namespace pprt
