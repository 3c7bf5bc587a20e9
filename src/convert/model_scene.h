// Models as scenes that can be rendered.
#pragma once

#include <optional>
#include <string>

#include "convert/default_view.h"
#include "convert/mesh/isolated_reader.h"
#include "parser/parsed_scene.h"
#include "scene/description/scene_description.h"

namespace pprt {

struct ModelOptions {
  MeshLimits limits = {};
  UpAxis up = UpAxis::kY;   // of an added view
  bool adds_lights = true;  // where it has none
};

struct Model {
  ParsedScene parsed;        // its warnings tell what was lost and what was added, a line each
  bool is_lit_anew = false;  // its lights are default_lights()
};

// Whether a name is that of a model's file.
bool is_model_name(const std::string& name);

// Reads a model, in a process of its own, and adds the view and the lights that it lacks. Throws InputError.
Model load_model(const std::string& path, const ModelOptions& options);

// Reads a model as it is in its file.
ParsedScene load_object(const std::string& path, const MeshLimits& limits);

// Whether time changes the scene.
bool moves(const SceneDescription& scene);

// Adds a view of what is seen at the animation's start, where the scene has none. Returns what to tell.
std::optional<std::string> complete_view(SceneDescription& scene, UpAxis up);

// Adds a background, where the scene has none. Returns what to tell.
std::optional<std::string> complete_background(SceneDescription& scene);

// Gives a scene that moves as many frames as show its whole time at this rate.
void set_rate(SceneDescription& scene, double frames_per_second);

// Lets the camera go round the middle of a scene that rests, once in four seconds. Default lights go with it.
void add_turn(SceneDescription& scene, UpAxis up, double frames_per_second, bool is_lit_anew);

}  // namespace pprt
