// Scene and script of a run.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "parser/anim/anim_parser.h"
#include "parser/parsed_scene.h"
#include "scene/animation/animation.h"

namespace pprt {

struct SourceOptions;

struct Sources {
  std::string script_path;  // as it was given; empty: there is no script
  std::optional<ParsedAnimation> script;
  std::string scene_path;  // or another name of a scene
  ParsedScene scene;
  std::set<std::string, std::less<>> own_names = {};  // of what the scene itself can move
  bool is_model = false;                              // the scene is a model's file
  bool is_lit_anew = false;                           // its lights have been added

  std::string warnings() const { return scene.warnings + (script ? script->warnings : ""); }
};

// Reads scene and script. Throws UsageError when the script is to name the scene and does not, InputError
// with every problem of the file.
Sources read_sources(const SourceOptions& options);

// Adds what the script moves to the scene. Throws InputError.
void add_objects(Sources& sources, const SourceOptions& options);

// Returns the times of the frames. Those of a script are spread over the scene's own animation; without one
// the first is at 0 and they follow each other at the script's rate.
FrameTimes frame_times(const Sources& sources);

// Returns the rate of a film: `fps`; if 0, the script's or that of the scene's own animation, whose frames
// have these times, else 25 frames/s.
double film_rate(double fps, const std::optional<ParsedAnimation>& script, const FrameTimes& times);

// Returns what a script in any directory calls the scene; nullopt: nothing can.
std::optional<std::string> absolute_scene_name(const std::string& path);

// Returns what the script moves, named as a script in any directory does.
std::vector<ObjectMotion> absolute_objects(const Sources& sources);

}  // namespace pprt
