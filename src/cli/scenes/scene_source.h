// Scenes and scripts named on a command line.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "parser/nff_parser.h"
#include "scene/animation/animation.h"

namespace pprt {

// Reads a scene: "spd:NAME[:SIZE]" is generated, "-" is NFF on standard input, FILE.aff is AFF with
// its includes and textures, anything else an NFF file.
// Throws InputError: no such database or file, too large, or rejected by the parser.
ParsedScene load_scene(const std::string& name, const NffOptions& options = {});

// Whether the name is that of an animation script, FILE.anim.
bool is_script_name(const std::string& name);

// Returns the scene that a script names, for load_scene(). A file's path in a script is relative to the
// script's directory. Throws UsageError when the script names none.
std::string scene_of_script(const Animation& script, const std::string& script_path);

// Reads scenes of formats that are not known here, by their names; empty for other names.
using OtherReader = std::function<std::optional<ParsedScene>(const std::string& name)>;

// Reads the scene that a script names. Throws InputError with the place in the script when there is no such
// scene or it cannot be read.
ParsedScene load_scene_of_script(const Animation& script, const std::string& script_path,
                                 const NffOptions& options = {}, const OtherReader& others = {});

// Adds what a script moves to the scene: a name of the scene itself, or else another scene, named as by
// scene_of_script(), with its warnings and files. `times`: of the script's frames. Throws InputError with the
// place in the script.
void add_objects(ParsedScene& parsed, const Animation& script, const std::string& script_path,
                 const FrameTimes& times, const NffOptions& options = {}, const OtherReader& others = {});

// Returns "spd:NAME" for every database.
std::vector<std::string> generated_scenes();

// Returns "; did you mean 'spd:teapot'?" for the name of a file that does not exist. Candidates are files in
// its directory and generated scenes; empty when none is close.
std::string hint_at_meant(const std::string& name);

// Throws InputError, with such a hint, when there is no such file.
void require_file(const std::string& path);

}  // namespace pprt
