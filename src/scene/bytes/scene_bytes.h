// A scene as bytes, for other processes.
#pragma once

#include <span>
#include <string>

#include "base/bytes.h"
#include "scene/description/scene_description.h"

namespace pprt {

// decode_scene() gives back all that encode() was given, bit by bit. It throws ProtocolError for bytes that
// are no scene. Indices within it are not checked: only encode() makes such bytes.
Bytes encode(const SceneDescription& scene);

// Returns the hash of a scene's content: of all but its name and the places in its files.
std::string hash_of(const SceneDescription& scene);

SceneDescription decode_scene(std::span<const std::byte> bytes);

}  // namespace pprt
