// Eric Haines' Standard Procedural Databases (version 3.14, public domain) as functions: size -> scene.
//
// Each scene equals what the SPD program of that name writes as NFF with true curves, before rounding to six
// digits: same objects, same order, same view and lights.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "scene/scene_description.h"

namespace pprt {

struct SpdDatabase {
  std::string_view name;  // "tree"
  int default_size = 1;   // the SPD program's own; teapot: 12, the size of the published statistics
};

// All databases, in the order in which messages and help list them.
std::span<const SpdDatabase> spd_databases();

// Larger scenes are refused before anything is made. The most memory a scene takes: 5.2 GB (teapot).
inline constexpr double kMaxSpdPrimitives = 20e6;

// Number of objects of a database, by closed formula; infinite where a double cannot hold it.
// `name` must be one of spd_databases(), size at least 1.
double spd_primitive_count(std::string_view name, int size);

// The scene, named "spd:NAME:SIZE"; absent size: the default. Throws InputError for a name that is not one of
// spd_databases(), for a size below 1, and for one that exceeds kMaxSpdPrimitives.
SceneDescription make_spd(std::string_view name, std::optional<int> size = {});

// Whether a scene is named in the form "spd:..." at all, rightly or wrongly.
bool is_spd_name(std::string_view scene);

// The scene named "spd:NAME" or "spd:NAME:SIZE". Throws InputError as make_spd, and for any other form.
SceneDescription make_spd_scene(std::string_view scene);

}  // namespace pprt
