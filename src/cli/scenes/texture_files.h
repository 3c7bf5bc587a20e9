// Reads the pictures that a scene's surfaces show.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"
#include "scene/description/scene_description.h"

namespace pprt {

// Sets what a texture shows; 1 and above become 255.
void fill(Texture& texture, const Image& image);

// Reads every texture of a scene that lies in `folder`: beside the scene, in TextureFiles/ there, or in
// ../TextureFiles/. Returns the files. Throws InputError that names every one that is not there or cannot be
// read.
std::vector<std::string> read_textures(SceneDescription& scene, const std::filesystem::path& folder);

}  // namespace pprt
