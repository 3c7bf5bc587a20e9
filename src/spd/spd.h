// Eric Haines' Standard Procedural Databases (version 3.14, public domain) as functions: size -> scene.
//
// Each scene equals the NFF output of the SPD program of that name with true curves, before rounding to six
// digits. Objects, their order, view and lights are the same.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "scene/description/scene_description.h"

namespace pprt {

struct SpdDatabase {
  std::string_view name;  // "tree"
  int default_size = 1;   // the SPD program's own, except teapot: 12, the size of the published statistics
};

// Returns all databases, in the order of messages and help.
std::span<const SpdDatabase> spd_databases();

// Limit on primitives; larger scenes are refused before any is made. The largest memory a scene takes is 5.2
// GB (teapot).
inline constexpr double kMaxSpdPrimitives = 20e6;

// Returns the number of objects of a database, by closed formula; infinite where a double cannot hold it.
// `name` must be one of spd_databases(), size at least 1.
double spd_primitive_count(std::string_view name, int size);

// Makes a scene, named "spd:NAME:SIZE"; without a size, the default. Throws InputError for an unknown name, a
// size below 1, and a size that exceeds kMaxSpdPrimitives.
SceneDescription make_spd(std::string_view name, std::optional<int> size = {});

// Returns whether a scene name begins with "spd:", whatever follows.
bool is_spd_name(std::string_view scene);

// Makes the scene named "spd:NAME" or "spd:NAME:SIZE". Throws InputError as make_spd does, and for any other
// form.
SceneDescription make_spd_scene(std::string_view scene);

}  // namespace pprt
