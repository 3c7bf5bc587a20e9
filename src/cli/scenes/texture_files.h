// Reads the pictures that a scene's surfaces show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"
#include "parser/parsed_scene.h"

namespace pprt {

// Sets what a texture shows; 1 and above become 255.
void fill(Texture& texture, const Image& image);

// Reads every texture of a scene that lies in `folder`: beside the scene, in TextureFiles/ there, or in
// ../TextureFiles/. Adds them to its files. Throws InputError that names every one that is not there, or
// cannot be read, or not within `max_memory` for the scene, bytes.
void read_textures(ParsedScene& parsed, const std::filesystem::path& folder, std::uint64_t max_memory);

}  // namespace pprt
